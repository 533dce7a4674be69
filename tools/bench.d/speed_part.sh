# Time a frame, profile by profile and stage by stage, beside the reference engine, OpenCV's LINEMOD, other instruction
# sets and numbers of threads, and what accuracy it buys: $out/speed. Sourced by tools/bench.

speed_scene=table_small_1
scene_distances=(--min-distance 0.75 --max-distance 2.1) # at which the objects of the test scenes stand

# profile_forest PROFILE: $data/PROFILE_forest, beside the default profile's $data/forest, which all parts use.
profile_forest() {
  cached "$1_forest" 'training background' "$bin/hs-study-train" --profile "$1" --threads "$(nproc)" \
    --out "$data/$1_forest" --views "bop:$data/training" --background "bop:$data/background"
}

# accuracy NAME COMMAND...: mean AUC over the scene's frames, as $out/speed/NAME/summary.json.
accuracy() {
  local name=$1
  shift
  step "speed: accuracy of $name"
  "$@" --scene "$data/scene/$speed_scene" --out "$out/speed/$name" >"$out/speed/$name.txt"
}

measure_accuracy() {
  local ranked=(--min-mass 0.05 --threshold 0) # every detection, for the whole precision-recall curve
  accuracy realtime "$bin/hs-evaluate" --forest "$data/forest" "${ranked[@]}" --threads "$(nproc)"
  accuracy paper "$bin/hs-evaluate" --forest "$data/paper_forest" "${ranked[@]}" --threads "$(nproc)"
  accuracy realtime_few "$bin/hs-evaluate" --forest "$data/forest" "${ranked[@]}" --every 12 --threads "$(nproc)"
  accuracy serial_few "$bin/hs-study-evaluate" --forest "$data/forest" "${ranked[@]}" --every 12 --reference --threads 1
  accuracy linemod "$bin/hs-linemod" --views "bop:$data/training" "${scene_distances[@]}" --threads "$(nproc)"
}

bench_speed() {
  local detectors=() threads set
  test_scene "$speed_scene"
  profile_forest paper
  profile_forest gall
  rm -rf "${out:?}/speed"
  mkdir -p "$out/speed"
  measure_accuracy
  for threads in $(seq "$(nproc)"); do detectors+=(--detector "threads_$threads=$data/forest,threads=$threads"); done
  for set in $("$bin/hs-bench-speed" --instruction-sets); do
    case $set in
      SSE4 | AVX2 | AVX3) detectors+=(--detector "set_$set=$data/forest,threads=1,set=$set") ;;
    esac
  done
  step "speed: side by side"
  "$bin/hs-bench-speed" --scene "$data/scene/$speed_scene" --every "$every" --out "$out/speed/times.json" \
    --detector "realtime=$data/forest,threads=$(nproc)" --detector "paper=$data/paper_forest,threads=$(nproc)" \
    --detector "serial=$data/forest,threads=1,reference,frames=3" \
    --detector "gall=$data/gall_forest,threads=1,reference,frames=1" \
    --detector "gall_engine=$data/gall_forest,threads=1,frames=2" "${detectors[@]}" \
    --linemod-views "bop:$data/training" "${scene_distances[@]}" --linemod-threads "$(nproc)"
  step "speed: kernels"
  "$bin/hs-bench-kernels" --scene "$data/scene/$speed_scene" --forest "$data/forest" --benchmark_repetitions=5 \
    --benchmark_report_aggregates_only=true --benchmark_out="$out/speed/kernels.json" --benchmark_out_format=json \
    >"$out/speed/kernels.txt"
}
