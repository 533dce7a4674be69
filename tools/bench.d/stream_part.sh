# A minute of replay through the processes, capture to pose, as compressed and as raw frames:
# $out/stream_compressed and $out/stream_raw. Sourced by tools/bench.

stream_rate=30
stream_seconds=60

# stream_log NAME CAPTURE_OPTIONS...: $data/NAME.lcmlog, the scene's frames over and over.
stream_log() {
  local name=$1
  shift
  cached "$name.lcmlog" stream_scene "$bin/hs-capture" --source "bop:$data/stream_scene" --rate $stream_rate \
    --loop --frames $((stream_rate * stream_seconds)) --log "$data/$name.lcmlog" "$@"
}

bench_stream() {
  cached stream_scene '' "$bin/hs-render" scene "$speed_scene" --frames 300 --out "$data/stream_scene" # every frame
  stream_log compressed
  stream_log raw --raw-colour --raw-depth
  local name
  for name in compressed raw; do
    step "stream: $stream_seconds s of $name frames at $stream_rate Hz"
    in_network tools/bench.d/stream "$data/$name.lcmlog" $((stream_rate * stream_seconds)) "$data/forest" \
      "$data/training/models" "$out/stream_$name"
  done
}
