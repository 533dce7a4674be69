#!/bin/sh
# Compiles through ccache: cached_compile.sh CCACHE COMPILER ARGUMENTS...
# A precompiled header has 150 MB, which ccache would read again for each source that includes it, a tenth of the build
# time: its checksum is left beside it, where ccache looks for one.
export CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_PCH_EXTSUM=true
header=
for word in "$@"; do
  case $word in *.gch) header=$word ;; esac
done
if [ -z "$header" ]; then exec "$@"; fi
rm -f "$header.sum"
"$@" && sha256sum <"$header" >"$header.sum"
