# SPDX-License-Identifier: BSD-3-Clause
# Doxygen reads the public headers through this: each header becomes a group of its own (gaussmap_core_pose_h), which
# docs/stage.py puts on a page. Lines keep their numbers.
FNR == 1 {
  id = FILENAME
  sub(/.*include\//, "", id)
  title = id
  gsub(/[\/.]/, "_", id)
}
{
  # "<random>" in a comment is a header, not a tag of HTML.
  at = index($0, "///")
  if (at > 0) {
    text = substr($0, at)
    while (match(text, /<[a-z_.\/]+>/))
      text = substr(text, 1, RSTART - 1) "\\<" substr(text, RSTART + 1, RLENGTH - 2) "\\>" substr(text, RSTART + RLENGTH)
    $0 = substr($0, 1, at - 1) text
  }
}
/^namespace gaussmap \{/ { $0 = $0 " /** @addtogroup " id " " title " */ /** @{ */" }
/^}  \/\/ namespace gaussmap$/ { $0 = "/** @} */ " $0 }
{ print }
