# What the shell scripts of this folder share. Sourced, not run, in the folder of the repository.

start_seconds=$(date +%s)

# A line of progress with the seconds since the start.
step() {
  printf '[%4d s] %s\n' "$(($(date +%s) - start_seconds))" "$*"
}

# One line to stderr, then the end.
die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# configure_and_build FOLDER BUILD_TYPE CMAKE_OPTIONS... -- TARGETS... (no target: everything)
# A folder that is new is built as a whole, several sources at a time; one that somebody configured stays as it is.
configure_and_build() {
  local folder=$1 build_type=$2
  shift 2
  local options=()
  [ -f "$folder/CMakeCache.txt" ] || options+=(-DCMAKE_UNITY_BUILD=ON)
  while [ $# -gt 0 ] && [ "$1" != -- ]; do
    options+=("$1")
    shift
  done
  shift
  cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE="$build_type" "${options[@]}" -Wno-dev |
    sed -n '/Houghstream/,$p' || return 1
  NINJA_STATUS='[%f/%t, %e s] ' cmake --build "$folder" --parallel "$(nproc)" ${1:+--target "$@"}
}

# study NAME OPTIONS...: hands over to tools/studies/NAME, which installs and builds what it needs. By Debian's Python,
# whose modules tools/packages.txt names; another one may come first in PATH.
study() {
  [ -x /usr/bin/python3 ] || tools/setup --demo
  HOUGHSTREAM_START=$start_seconds PYTHONPATH=tools exec /usr/bin/python3 -m "studies.$1" "${@:2}"
}
