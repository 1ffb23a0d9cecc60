# What scripts that drive the real window share; $1: the program, $2: a folder for pictures and recordings.
# Starts the script again under Xvfb, in that folder, emptied.
set -euo pipefail
program=$(realpath "$1") script=$(realpath "$0")
mkdir -p "$2"
folder=$(realpath "$2")
if [ -z "${TOPPLE_UI_DISPLAY:-}" ]; then
  export TOPPLE_UI_DISPLAY=1
  exec xvfb-run -a -s "-screen 0 1280x720x24 -noreset" "$script" "$program" "$folder"
fi
cd "$folder"
rm -rf ./*.png ./*.h5 ./*.toml ./*.mp4 state cache config

fail() { echo "$(basename "$0"): $*" >&2; exit 1; }
open_window() {  # arguments of topple view
  XDG_STATE_HOME=$folder/state XDG_CACHE_HOME=$folder/cache XDG_CONFIG_HOME=$folder/config "$program" view "$@" > said.txt 2>&1 &
  process=$!
  for _ in $(seq 100); do
    window=$(xdotool search --name '^topple' 2>/dev/null | head -1) && [ -n "$window" ] && break
    kill -0 "$process" 2>/dev/null || fail "the window did not open: $(cat said.txt)"
    sleep 0.1
  done
  until xdotool windowfocus "$window" 2>/dev/null; do sleep 0.1; done  # it is not shown yet
  for _ in $(seq 100); do  # its first picture
    import -window root first.png
    [ "$(identify -format '%k' first.png)" -gt 500 ] && break
    sleep 0.2
  done
  sleep 1.5
}
key() { xdotool key "$1"; sleep 0.3; }
click() { xdotool mousemove "$1" "$2"; sleep 0.15; xdotool mousedown 1; sleep 0.15; xdotool mouseup 1; sleep 0.3; }
drag() {  # from x y to x y
  xdotool mousemove "$1" "$2"; sleep 0.15; xdotool mousedown 1; sleep 0.15
  xdotool mousemove $((($1 + $3) / 2)) $((($2 + $4) / 2)); sleep 0.1
  xdotool mousemove "$3" "$4"; sleep 0.15; xdotool mouseup 1; sleep 0.3
}
shot() {
  import -window root "$1.png"
  local colours
  colours=$(identify -format '%k' "$1.png")
  [ "$colours" -gt 500 ] || fail "$1.png shows next to nothing: $colours colours"
}
differ() {  # two pictures, pixels that differ at least
  local pixels
  pixels=$(compare -metric AE "$1.png" "$2.png" null: 2>&1 || true)
  awk -v n="$pixels" -v least="$3" 'BEGIN { exit !(n >= least) }' || fail "$1 and $2 differ in $pixels pixels only"
}
ended_with() {
  local code=0
  wait "$process" || code=$?
  [ "$code" = "$1" ] || fail "exit code $code instead of $1: $(cat said.txt)"
}
wait_for() {  # seconds, command: until it succeeds
  for _ in $(seq $((5 * $1))); do "${@:2}" && return 0; sleep 0.2; done
  return 1
}
changed() {  # region, pixels: the window differs there by as many from what it was before
  import -window root -crop "$1" +repage now.png
  local pixels
  pixels=$(compare -metric AE before.png now.png null: 2>&1 || true)
  awk -v n="$pixels" -v least="$2" 'BEGIN { exit !(n >= least) }'
}
act() {  # region, pixels, action: until it changes what is shown there
  import -window root -crop "$1" +repage before.png
  for _ in 1 2 3 4 5 6; do
    "${@:3}"
    wait_for 3 changed "$1" "$2" && return 0
  done
  fail "nothing changed at $1: ${*:3}"
}
calm() {  # nothing moves, frames are fast
  import -window root -crop 1280x690+0+0 +repage before.png
  sleep 0.7
  ! changed 1280x690+0+0 1
}
slow_click() {
  xdotool mousemove "$1" "$2"; sleep 0.5; xdotool mousedown 1; sleep 0.4; xdotool mouseup 1; sleep 0.6
}
