// SPDX-License-Identifier: BSD-3-Clause
// Compresses a LAS file with LASzip: make_laz FILE.las FILE.laz. See make.py.
#include <laszip_api.h>

#include <cstdio>
#include <cstdlib>

namespace {

void require(laszip_I32 failed, laszip_POINTER laszip) {
  if (!failed) return;
  laszip_CHAR* error = nullptr;
  laszip_get_error(laszip, &error);
  std::fprintf(stderr, "%s\n", error ? error : "unknown error of LASzip");
  std::exit(1);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  laszip_POINTER reader = nullptr, writer = nullptr;
  if (laszip_create(&reader) || laszip_create(&writer)) return 1;
  laszip_BOOL is_compressed = 0;
  require(laszip_open_reader(reader, argv[1], &is_compressed), reader);
  laszip_header_struct* header = nullptr;
  require(laszip_get_header_pointer(reader, &header), reader);
  require(laszip_set_header(writer, header), writer);
  require(laszip_open_writer(writer, argv[2], 1), writer);
  laszip_point_struct* point = nullptr;
  require(laszip_get_point_pointer(reader, &point), reader);
  for (laszip_U32 i = 0; i < header->number_of_point_records; ++i) {
    require(laszip_read_point(reader), reader);
    require(laszip_set_point(writer, point), writer);
    require(laszip_write_point(writer), writer);
  }
  require(laszip_close_writer(writer), writer);
  require(laszip_close_reader(reader), reader);
  laszip_destroy(writer);
  laszip_destroy(reader);
  return 0;
}
