// SPDX-License-Identifier: BSD-3-Clause
// Writes PLY files with the PLYExporter of three.js, then reads all files with its PLYLoader and writes the values
// to .txt files: the names of the columns, then one line per point.
// Run in a folder with the package: npm install three@0.187.0 (see make.py).
import fs from 'node:fs';
import * as THREE from 'three';
import {PLYExporter} from 'three/examples/jsm/exporters/PLYExporter.js';
import {PLYLoader} from 'three/examples/jsm/loaders/PLYLoader.js';

const folder = process.argv[2] ?? '.';
let state = 12345;
const random = () => (state = (state * 1103515245 + 12345) % 2 ** 31) / 2 ** 31;

const count = 24;
const filled = (width, value) => new Float32Array(width * count).map(value);
const geometry = new THREE.BufferGeometry();
geometry.setAttribute('position', new THREE.BufferAttribute(filled(3, () => random() * 200 - 100), 3));
geometry.setAttribute('normal', new THREE.BufferAttribute(filled(3, () => random() * 2 - 1), 3));
const points = new THREE.Points(geometry);
for (const [name, options] of [['three_ascii', {}], ['three_little', {binary: true, littleEndian: true}], ['three_big', {binary: true}]]) {
  const written = new PLYExporter().parse(points, undefined, options);
  fs.writeFileSync(`${folder}/${name}.ply`, typeof written === 'string' ? written : Buffer.from(written));
}

for (const file of fs.readdirSync(folder).filter((f) => f.endsWith('.ply')).sort()) {
  const bytes = new Uint8Array(fs.readFileSync(`${folder}/${file}`));
  const loader = new PLYLoader();
  const header = new TextDecoder().decode(bytes).split('end_header')[0];
  const vertex = header.slice(header.indexOf('element vertex')).split('element ')[1];
  const properties = [...vertex.matchAll(/property (\w+) (\w+)/g)].map((m) => m[2]).filter((p) => p !== 'list');
  const mapping = {};
  for (const p of properties) mapping[`value_${p}`] = [p];
  loader.setCustomPropertyNameMapping(mapping);
  const read = loader.parse(bytes.buffer);
  const value = (p, i) => read.getAttribute(`value_${p}`).array[i];
  const isColour = (p) => ['red', 'green', 'blue'].includes(p);
  const names = properties.filter((p) => !isColour(p)).concat(properties.includes('red') ? ['rgb'] : []);
  const rows = [names.join(' ')];
  for (let i = 0; i < read.getAttribute('position').count; ++i)
    rows.push(names.map((p) => p === 'rgb' ? value('red', i) * 65536 + value('green', i) * 256 + value('blue', i)
                                           : String(value(p, i)).toLowerCase()).join(' '));
  fs.writeFileSync(`${folder}/${file.replace('.ply', '.txt')}`, rows.join('\n') + '\n');
}
