// SPDX-License-Identifier: BSD-3-Clause
// Reads LAZ files with the npm package laz-perf 0.0.7 and writes their points as NAME.records: the records of the
// uncompressed LAS file. usage: node read.mjs FILE.laz...
import fs from 'node:fs';
import { createLazPerf } from 'laz-perf';

const lib = await createLazPerf();
for (const path of process.argv.slice(2)) {
  const bytes = fs.readFileSync(path);
  const file = lib._malloc(bytes.length);
  lib.HEAPU8.set(bytes, file);
  const reader = new lib.LASZip();
  reader.open(file, bytes.length);
  const length = reader.getPointLength();
  const count = reader.getCount();
  const point = lib._malloc(length);
  const records = Buffer.alloc(count * length);
  for (let i = 0; i < count; ++i) {
    reader.getPoint(point);
    records.set(lib.HEAPU8.subarray(point, point + length), i * length);
  }
  fs.writeFileSync(path.replace(/\.laz$/, '.records'), records);
  reader.delete();
  lib._free(point);
  lib._free(file);
}
