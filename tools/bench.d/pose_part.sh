# Poses on the six test scenes beside PCL's ICP and two other methods, and on camera-recorded data where that is there:
# $out/pose.json. Sourced by tools/bench.

bench_rendered_poses() {
  local scene options=()
  for scene in $test_scenes; do
    test_scene "$scene"
    options+=(--scene "$data/scene/$scene")
  done
  step "poses: ours, PCL's, and of two other methods"
  "$bin/hs-bench-pose" --forest "$data/forest" --models "$data/training/models" "${options[@]}" --every "$every" \
    --rivals-every "$rivals_every" --threads "$(nproc)" --out "$out/pose"
}

# Models are fused of the training views; the compared object's is replaced by its scanned mesh.
bench_recorded_poses() {
  set_recorded_views
  cached real_forest '' "$bin/hs-train" --threads "$(nproc)" --out "$data/real_forest" "${recorded_views[@]}" \
    --background "images:$real/background"
  cached real_models '' "$bin/hs-fuse" --threads "$(nproc)" --out "$data/real_models" "${recorded_views[@]}"
  step "poses: recorded frames"
  "$bin/hs-bench-real" --scenes "$real/scenes" --forest "$data/real_forest" \
    --models "$data/real_models" --scan "$real/model/ornament_3.obj" \
    --references "$real/scenes/pseudo_poses_ornament_3.json" --threshold 0.01 --threads "$(nproc)" --out "$out/real"
}

bench_pose() {
  rm -rf "${out:?}/real" # what an earlier run measured does not speak for this one
  bench_rendered_poses
  [ -z "$real" ] || bench_recorded_poses
  python3 tools/bench.d/pose_report.py "$out" --commit "$commit"
}
