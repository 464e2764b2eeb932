# SPDX-License-Identifier: BSD-3-Clause
# What `PROGRAM --help` prints, as the options' part of a manual page: so the two never differ. -v title=... heads it,
# with the help's own first line and usage below.
function escaped(text) {
  gsub(/\\/, "\\e", text)
  gsub(/-/, "\\-", text)
  sub(/^['.]/, "\\\\\\&&", text)
  # Where long words may be broken: chessboard:COLSxROWS:SQUARE_MM, hand_qw,hand_qx,hand_qy
  gsub(/:[A-Z]/, "\\:&", text)
  while (match(text, /,[a-z]/)) text = substr(text, 1, RSTART) "\\:" substr(text, RSTART + 1)
  return text
}
# CLI11 writes "--body N:INT in [0 - 999]", "--eye TEXT:{sfm,pattern}=sfm"; a manual "--body N (0 to 999)", "--eye sfm|pattern".
function as_in_a_manual(spec,    parts, choices) {
  if (match(spec, /:[A-Z]+ in \[[^]]*\]/)) {
    parts = substr(spec, RSTART, RLENGTH)
    sub(/^[^[]*\[/, "(", parts); sub(/ - /, " to ", parts); sub(/\]$/, ")", parts)
    spec = substr(spec, 1, RSTART - 1) " " parts substr(spec, RSTART + RLENGTH)
  }
  if (match(spec, /(TEXT|NAME|[A-Z]+):\{[^}]*\}/)) {
    choices = substr(spec, RSTART, RLENGTH)
    sub(/^[A-Z]+:\{/, "", choices); sub(/\}$/, "", choices); gsub(/,/, "|", choices)
    spec = substr(spec, 1, RSTART - 1) choices substr(spec, RSTART + RLENGTH)
  }
  sub(/:(POSITIVE|NUMBER)/, "", spec)
  sub(/ (TEXT|UINT|INT|FLOAT)( |=|$)/, " VALUE&", spec); sub(/VALUE (TEXT|UINT|INT|FLOAT)/, "VALUE", spec)
  if (match(spec, /[A-Za-z|) ]=[^ ]+( x [0-9]+)?/)) {  # not the "[=AMOUNT]" of a value's own form
    parts = substr(spec, RSTART + 2, RLENGTH - 2)
    spec = substr(spec, 1, RSTART) substr(spec, RSTART + RLENGTH)
    sub(/ x [0-9]+$/, "", parts); gsub(/[][]/, "", parts)
    if (parts != "") spec = spec ", default " parts
  }
  return spec
}
function item(spec, text) {
  print ".TP"
  print ".B " escaped(as_in_a_manual(spec))
  if (text != "") print escaped(text)
}
BEGIN { print ".ad l"; if (title != "") print ".SS " escaped(title) }
/^[[:space:]]*$/ { next }
!described && !/^Usage:/ { described = 1; if (title != "") print escaped($0); next }
/^Usage:/ { described = 1; print ".PP"; print ".B " escaped(substr($0, 8)); next }
/^(Options|Positionals|Subcommands):$/ { section = $1; next }
/^  [^ ]/ && section != "" {
  line = substr($0, 3)
  at = match(line, /   +/)
  if (at == 0) item(line, ""); else item(substr(line, 1, at - 1), substr(line, at + RLENGTH))
  next
}
/^      / && section != "" { sub(/^ +/, ""); print escaped($0); next }
{ section = ""; print ".PP"; print escaped($0) }
