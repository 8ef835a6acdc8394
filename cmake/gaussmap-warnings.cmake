# SPDX-License-Identifier: BSD-3-Clause
# Warnings for the code of gaussmap only. They do not apply to programs that use gaussmap.
add_library(gaussmap_warnings INTERFACE)
target_compile_options(gaussmap_warnings INTERFACE
  $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang>:-Wall -Wextra -Wpedantic -Wshadow -Wconversion>
  # With g++, -Wconversion does not include sign conversions, so clang does not warn of them either.
  $<$<COMPILE_LANG_AND_ID:CXX,Clang>:-Wno-sign-conversion>)
