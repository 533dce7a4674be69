# Makes Debian's changelog of the newest section of tools/CHANGELOG.md: each of its items is one, in lines of 80 columns.
function put_item(    words, count, i, line) {
  if (item == "") return
  count = split(item, words, " ")
  line = "  *"
  for (i = 1; i <= count; ++i) {
    if (length(line) + 1 + length(words[i]) > 80 && line !~ /^ *$/) {
      print line
      line = "   "
    }
    line = line " " words[i]
  }
  print line
  item = ""
}

BEGIN { printf "houghstream (%s) unstable; urgency=low\n\n", version }
/^## \[/ { ++sections }
sections != 1 { next }
/^- / { put_item(); item = substr($0, 3) }
/^  / { item = item " " substr($0, 3) }
END { put_item(); printf "\n -- %s\n", signature }
