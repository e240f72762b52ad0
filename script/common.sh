# Shared by the scripts beside it: where the project is, how to say things, how to build a preset. Sourced, not run.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
say() { printf '\n== %s\n' "$*" >&2; }
fail() { printf '%s: %s\n' "${0##*/}" "$*" >&2; exit 1; }
# Wrong usage: exit 2, as the program itself does.
usage_error() { printf '%s: unknown argument %s (try -h)\n' "${0##*/}" "$1" >&2; exit 2; }
# Prints the comment block at the head of the calling script.
help() { sed -n '2,/^[^#]/{/^#/s/^# \{0,1\}//p}' "$0"; exit 0; }
jobs=${SPANRAY_JOBS:-$(nproc)}
# A build folder made elsewhere (another checkout, moved tree) cannot be used: CMake refuses it, so start afresh.
drop_foreign_cache() {
  local home
  [ -f "$1/CMakeCache.txt" ] || return 0
  home=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$1/CMakeCache.txt")
  [ "$home" = "$root" ] || rm -rf "$1"
}
launcher() { if command -v ccache >/dev/null; then echo "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"; fi; }
# configure PRESET BINARY_DIR [cmake options]
configure() {
  local preset=$1 dir=$2
  shift 2
  drop_foreign_cache "$root/$dir"
  # shellcheck disable=SC2046
  cmake -S "$root" --preset "$preset" -B "$root/$dir" $(launcher) "$@" >"$root/$dir.log" 2>&1 ||
    { cat "$root/$dir.log" >&2; fail "CMake could not configure $preset"; }
}
# build BINARY_DIR [targets]: all targets when none is named.
build() {
  local dir=$1
  shift
  if [ $# -gt 0 ]; then cmake --build "$root/$dir" -j "$jobs" --target "$@" >&2
  else cmake --build "$root/$dir" -j "$jobs" >&2; fi
}
# expect_build FILE CPU_MINUTES WHAT: before FILE was ever built, says how long that takes.
expect_build() {
  [ ! -e "$1" ] || return 0
  local minutes=$((($2 + jobs - 1) / jobs)) processors=processors
  [ "$jobs" -ne 1 ] || processors=processor
  say "first build of $3: about $2 minutes of processor time, so up to $minutes min on $jobs $processors"
}
# frame_ms FILE: the median frame time in statistics of `spanray render`, as "N.N ms"; nothing if there is none.
frame_ms() {
  local ms
  ms=$(sed -nE 's/^ *"frame": *([0-9]+(\.[0-9]+)?),?$/\1/p' "$1" 2>/dev/null | head -n 1)
  [ -z "$ms" ] || LC_ALL=C printf '%.1f ms' "$ms"
}
# Inside $root, since presets are looked up there; build/ must exist for the logs.
enter_root() { cd "$root" && mkdir -p build out; }
