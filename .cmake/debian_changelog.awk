# Makes Debian's changelog of the newest section of tools/CHANGELOG.md: each of its items is one.
BEGIN { printf "houghstream (%s) unstable; urgency=low\n\n", version }
/^## \[/ { ++sections; next }
sections == 1 && /^- / { printf "  * %s\n", substr($0, 3) }
sections == 1 && /^  / { printf "    %s\n", substr($0, 3) }
END { printf "\n -- %s\n", signature }
