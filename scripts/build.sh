#!/usr/bin/env bash
# Builds Furrow. Everything goes to stderr: quiet unless something fails, and quick when nothing changed.
set -euo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd -P)

usage() { cat <<'HELP'
usage: scripts/build.sh [--portable | --debug | --preset NAME] [TARGET ...]
Builds into build/, tuned for the processor of this machine. System packages that are missing are installed
first (scripts/setup.sh; not where FURROW_NO_SETUP is set). Without targets everything is built.
  --portable     for any processor of this kind, into build-portable/
  --debug        for a debugger, warnings are errors, into build-dev/
  --preset NAME  any preset of CMakePresets.json, into build-NAME/ ("release" is build/)
HELP
}

say() { printf 'build: %s\n' "$*" >&2; }
die() { say "error: $*"; exit 1; }

preset=release targets=()
while (($#)); do
  case $1 in
    --portable) preset=portable ;;
    --debug) preset=dev ;;
    --preset) (($# > 1)) || die '--preset needs a name'; preset=$2; shift ;;
    -h|--help) usage; exit 0 ;;
    -*) usage >&2; die "unknown option '$1'" ;;
    *) targets+=("$1") ;;
  esac
  shift
done
build=$root/build; [[ $preset == release ]] || build=$root/build-$preset

if [[ -z ${FURROW_NO_SETUP:-} ]] && ! "$root/scripts/setup.sh" --check 2>/dev/null; then
  "$root/scripts/setup.sh" || die 'cannot build without these packages (FURROW_NO_SETUP=1 tries all the same)'
fi

cd -- "$root"
mkdir -p -- "$build"
exec 9>"$build/.lock"
if command -v flock >/dev/null && ! flock -n 9; then
  say 'waiting for another build'
  flock 9
fi

# A checkout that was moved or copied cannot use the old build folder.
cache=$build/CMakeCache.txt
if [[ -f $cache ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$cache"; then
  say "${build##*/}/ was made for another folder: starting afresh"
  find "$build" -mindepth 1 -maxdepth 1 ! -name .lock -exec rm -rf {} +
fi

log=$build/build.log
fail() {
  grep -vE '^\[[0-9]+/[0-9]+\]|^ninja: (Entering|build stopped)' "$log" >&2 || true
  die "$1 (all of it: ${log#"$root"/})"
}

start=$SECONDS
if [[ ! -f $build/build.ninja ]]; then
  say 'configuring'
  cmake --preset "$preset" >"$log" 2>&1 || { rm -f "$build/build.ninja"; fail 'cmake failed'; }
fi

# One compiler needs up to 1.5 GB.
jobs=$(nproc)
memory_kib=$(awk '$1 == "MemAvailable:" {print $2}' /proc/meminfo 2>/dev/null || true)
by_memory=$((${memory_kib:-1500000} / 1500000))
((by_memory >= jobs)) || jobs=$((by_memory > 0 ? by_memory : 1))

# What is compiled: a counter on a terminal, else a line at each fifth.
show() {
  local line shown=0 done all
  while IFS= read -r line; do
    [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]] || continue
    done=${BASH_REMATCH[1]} all=${BASH_REMATCH[2]}
    if [[ -t 2 ]]; then
      printf '\rbuild: %d of %d\033[K' "$done" "$all" >&2
    elif ((all >= 10 && 5 * done / all > shown)); then
      shown=$((5 * done / all))
      say "$done of $all"
    fi
  done
  [[ ! -t 2 ]] || printf '\r\033[K' >&2
}
ninja -C "$build" -j "$jobs" "${targets[@]}" 2>&1 | tee "$log" | show || fail 'compilation failed'
if ((SECONDS - start > 2)); then say "done in $((SECONDS - start)) s"; fi
