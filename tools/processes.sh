# Processes in the background and frames sent to them, for scripts that run the whole stream. Sourced after common.sh,
# not run; needs $process_words, a folder for what each says. Whatever still runs when the script ends is ended.

declare -A pids
start() {
  local name=$1
  shift
  "$@" >"$process_words/$name.txt" 2>&1 &
  pids[$name]=$!
}

show_words() {
  for file in "$process_words"/*.txt; do
    [ ! -s "$file" ] || sed "s|^|  $(basename "$file" .txt): |" "$file" >&2
  done
}

# stop SECONDS NAME...: asks nicely, waits, insists after so many seconds.
stop() {
  local patience=$1
  shift
  for name in "$@"; do kill -INT "${pids[$name]}" 2>/dev/null || true; done
  for name in "$@"; do
    for _ in $(seq $((10 * patience))); do
      kill -0 "${pids[$name]}" 2>/dev/null || break
      sleep 0.1
    done
    kill -KILL "${pids[$name]}" 2>/dev/null && step "$name did not end when asked" || true
    wait "${pids[$name]}" || { show_words; die "$name failed"; }
    unset "pids[$name]"
  done
}
trap 'kill "${pids[@]}" 2>/dev/null || true' EXIT

await_ready() {
  for name in "$@"; do
    for _ in $(seq 300); do
      grep -q 'ready' "$process_words/$name.txt" && continue 2
      kill -0 "${pids[$name]}" 2>/dev/null || break
      sleep 0.1
    done
    show_words
    die "$name did not get ready"
  done
}

# play COMMAND...: runs what sends the frames to its end, and waits for the observer, who ends by himself when all frames
# have come and the bus is quiet.
play() {
  "$@" >"$process_words/player.txt" 2>&1 || { show_words; die "the frames could not be sent: $1 failed"; }
  for _ in $(seq 80); do
    kill -0 "${pids[observe]}" 2>/dev/null || break
    sleep 0.1
  done
}
