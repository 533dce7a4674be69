# How time grows with objects, trees, pixels and LINEMOD's templates: $out/growth. Sourced by tools/bench.

# The first N of forty objects are taught from fewer views than usual: enough for how the time grows.
growth_objects='1 2 4 8 12 20 30 40'
growth_views=(--azimuths 18 --pitches 2)

# objects_forest N
objects_forest() {
  local names
  names=$(python3 -c 'import json, sys
names = json.load(open(sys.argv[1]))
print(",".join(names[key] for key in sorted(names, key=int)[: int(sys.argv[2])]))' "$data/growth/views_40/models/names.json" "$1")
  cached "growth/views_$1" '' "$bin/hs-render" training --objects "$names" "${growth_views[@]}" --out "$data/growth/views_$1"
  cached "growth/objects_$1" "growth/views_$1 background" "$bin/hs-train" --threads "$(nproc)" --composites 2 \
    --out "$data/growth/objects_$1" --views "bop:$data/growth/views_$1" --background "bop:$data/background"
}

bench_growth() {
  local n detectors=()
  test_scene "$speed_scene"
  cached growth/views_40 '' "$bin/hs-render" training --objects all_40 "${growth_views[@]}" --out "$data/growth/views_40"
  for n in $growth_objects; do
    objects_forest "$n"
    detectors+=(--detector "objects_$n=$data/growth/objects_$n,threads=$(nproc)")
  done
  cached growth/trees_30 'training background' "$bin/hs-train" --trees 30 --threads "$(nproc)" \
    --out "$data/growth/trees_30" --views "bop:$data/training" --background "bop:$data/background"
  for n in 5 10 15 20 30; do detectors+=(--detector "trees_$n=$data/growth/trees_30,threads=$(nproc),trees=$n"); done
  for n in 0.5 1 1.5 2; do detectors+=(--detector "scale_$n=$data/forest,threads=$(nproc),scale=$n"); done
  mkdir -p "$out/growth"
  step "growth: side by side"
  "$bin/hs-bench-speed" --scene "$data/scene/$speed_scene" --every "$every" --out "$out/growth/times.json" "${detectors[@]}"
}
