# What tools/setup, tools/test and tools/demo share. Sourced, not run.

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
configure_and_build() {
  local folder=$1 build_type=$2
  shift 2
  local options=()
  while [ $# -gt 0 ] && [ "$1" != -- ]; do
    options+=("$1")
    shift
  done
  shift
  cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE="$build_type" "${options[@]}" -Wno-dev |
    sed -n '/Houghstream/,$p' || return 1
  NINJA_STATUS='[%f/%t, %e s] ' cmake --build "$folder" --parallel "$(nproc)" ${1:+--target "$@"}
}
