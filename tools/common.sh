# What the scripts of this folder share. Sourced, not run.

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

# The commit that is checked out, short.
commit_name() {
  git rev-parse --short HEAD 2>/dev/null || echo unknown
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

# cached NAME INPUTS COMMAND...: makes $data/NAME by the command, unless the same command of the same build has made it
# before from the same inputs (names of earlier ones, as one word). Needs $data, and $fresh: yes makes it anyway.
cached() {
  local name=$1 inputs=$2 stamp
  shift 2
  stamp=$(echo "$*"; sha256sum "$1"; for input in $inputs; do sha256sum "$data/$input.stamp"; done)
  if [ "$fresh" = no ] && [ "$(cat "$data/$name.stamp" 2>/dev/null)" = "$stamp" ]; then
    step "$name: unchanged"
    return
  fi
  step "$name"
  rm -rf "${data:?}/$name" "$data/$name.stamp"
  mkdir -p "$(dirname "$data/$name")"
  "$@" | tee "$data/$name.words"
  echo "$stamp" >"$data/$name.stamp"
}

# Rendered views and rooms, and the forest that is trained on them: $data/training, background, forest. Needs $bin too.
rendered_forest() {
  cached training '' "$bin/hs-render" training --out "$data/training"
  cached background '' "$bin/hs-render" background --count 215 --out "$data/background"
  cached forest 'training background' "$bin/hs-train" --threads "$(nproc)" --out "$data/forest" \
    --views "bop:$data/training" --background "bop:$data/background"
}

# Camera-recorded data in DIR/objects, background, scenes: its camera, and the options that name the training views in $real.
recorded_camera=640x480,525,525,319.5,239.5
set_recorded_views() {
  recorded_views=(--views "uw:$real/objects" --camera $recorded_camera --rename can_1=can,can_2=can
    --instances ornament_3,ornament_1,koaramarch_1,pack_2,bottle_2,can_1,can_2)
}

# in_network COMMAND...: on a private network that carries multicast, or, with $shared_bus yes, on this machine's own.
in_network() {
  local setup='ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo && exec "$@"'
  if [ $shared_bus = yes ]; then
    "$@"
  elif unshare -n true 2>/dev/null; then # as root, who keeps the right to raise a priority
    unshare -n bash -c "$setup" private "$@"
  elif unshare -rn true 2>/dev/null; then
    unshare -rn bash -c "$setup" private "$@"
  else
    step "a private network is refused (user namespaces are off): using this machine's own, as --shared-bus does"
    "$@"
  fi
}
