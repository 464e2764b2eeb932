# SPDX-License-Identifier: BSD-3-Clause
# The keys' table of docs/configuration.md, as the keys' part of a manual page.
function plain(text) {
  gsub(/\\/, "\\e", text)
  text = gensub_links(text)
  gsub(/`/, "", text)
  gsub(/-/, "\\-", text)
  sub(/^ +/, "", text); sub(/ +$/, "", text)
  sub(/^['.]/, "\\\\\\&&", text)
  return text
}
# [words](page) becomes: words
function gensub_links(text,    before, link, words) {
  while (match(text, /\[[^]]*\]\([^)]*\)/)) {
    before = substr(text, 1, RSTART - 1)
    link = substr(text, RSTART, RLENGTH)
    words = link; sub(/^\[/, "", words); sub(/\]\(.*$/, "", words)
    text = before words substr(text, RSTART + RLENGTH)
  }
  return text
}
/^\| `\[/ {
  split($0, cells, /\|/)
  key = cells[2]; value = plain(cells[3])
  section = key; sub(/^[^[]*\[/, "", section); sub(/\].*$/, "", section)
  if (section != last) { print ".SS [" section "]"; last = section }
  sub(/\[[^]]*\]/, "", key)
  print ".TP"
  print ".B " plain(key)
  text = cells[4]
  for (i = 5; i < length(cells); ++i) text = text "|" cells[i]
  print plain(text)
  print ".br"
  print "Default: " (value == "" ? "none" : value)
}
