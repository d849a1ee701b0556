#!/usr/bin/env bash
# Builds and runs the tests. Fails if a test fails, and if there was none to run.
set -euo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd -P)

usage() { cat <<'HELP'
usage: scripts/test.sh [--label LABEL]... [--preset NAME] [-- CTEST-OPTION ...]
Builds everything and runs the tests with the labels unit, mpi and system; or builds what the labels given need, and
runs those.
  --label LABEL  unit, mpi, system, verify (longer comparisons),
                 campaign (hours), fresh (bare Debian machine; needs root),
                 cluster (Slurm and an image; skipped where they are not installed), browser (report.html in Chromium),
                 docs (the documentation site and the commands of its tutorial),
                 network (what needs package registries),
                 package (the CMake package with its example project, the Debian package)
  --preset NAME  a preset of CMakePresets.json, for example asan
  --             what follows goes to ctest, for example -- -R terrain
HELP
}

labels='' preset=release
while (($#)); do
  case $1 in
    --label) (($# > 1)) || { usage >&2; exit 1; }; labels+="${labels:+|}$2"; shift ;;
    --preset) (($# > 1)) || { usage >&2; exit 1; }; preset=$2; shift ;;
    -h|--help) usage; exit 0 ;;
    --) shift; break ;;
    *) usage >&2; printf "test: error: unknown option '%s'\n" "$1" >&2; exit 1 ;;
  esac
  shift
done
build=$root/build; [[ $preset == release ]] || build=$root/build-$preset

targets=()
case $labels in unit|verify) targets=("tests_$labels") ;; esac
"$root/scripts/build.sh" --preset "$preset" "${targets[@]}"
# Tests of runs wait for a quarter of their time.
exec ctest --test-dir "$build" -L "^(${labels:-unit|mpi|system})\$" -j "$(($(nproc) + 2))" --no-tests=error \
  --output-on-failure "$@"
