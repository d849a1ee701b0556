#!/usr/bin/env bash
# Checks and measures grains on a GPU, on a machine that has the GPU but none of the packages of Furrow.
set -euo pipefail
here=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")" && pwd -P)

usage() { cat <<'HELP'
usage: scripts/gpu_check.sh bundle FILE.tar.gz [BUILD]
       gpu_check.sh check OUT [--emulated]
       gpu_check.sh bed OUT [--emulated]
bundle   packs the build in BUILD (build-portable/) into FILE, with its libraries, Open MPI, scenarios, a settled bed,
         and the hashes that the emulation gives after 1,000 steps. It takes minutes.
check    in the unpacked bundle: compares bits with these hashes, runs the unit tests and a short run of the reference
         rig, measures speed, and checks memory. At most 5 minutes.
bed      in the unpacked bundle: settles grains of 2.5 mm, and drives the reference tire over them. At most 5 minutes.
OUT/check.json and OUT/bed.json are written anew after each stage. The machine needs bash, coreutils, awk, glibc, and
for memory and counters compute-sanitizer and ncu. --emulated rehearses the stages on the processor, with few grains
and in six times the time.
HELP
}
say() { printf 'gpu_check: %s\n' "$*" >&2; }
die() { say "error: $*"; exit 2; }

# ---- the bundle ------------------------------------------------------------------------------------------------------

# Shared libraries of programs, except those of glibc.
libraries_of() {
  ldd "$@" | awk '$2 == "=>" && $3 ~ /^\// {print $3}' | grep -vE '/(libc|libm|libdl|librt|libpthread|libresolv)\.so' |
    sort -u
}

# A loose lattice of grains of 6 mm in a bin of 1 m × 0.6 m that is periodic along x, as CSV.
lattice() {
  awk 'function any() { seed = (seed * 16807) % 2147483647; return seed / 2147483647 - 0.5 }
       BEGIN {
         seed = 7; print "x_m,y_m,z_m"
         for (k = 0; k < 13; ++k) for (j = 0; j < 42; ++j) for (i = 0; i < 72; ++i)
           printf "%.9f,%.9f,%.9f\n", (i + 0.25 + k % 2 / 2) / 72 + 0.0008 * any(),
             0.0075 + 0.0139 * j + k % 2 * 0.007 + 0.0008 * any(), 0.0075 + 0.0139 * k + 0.0008 * any()
       }'
}

bundle() {
  (($# == 1 || $# == 2)) || { usage >&2; exit 2; }
  local root=${here%/*} file build work to part
  file=$(realpath -m -- "$1") build=$(realpath -m -- "${2:-$root/build-portable}")
  for part in furrow libfurrow_gpu.so gpu_emulation/terrain_gpu gpu_emulation/libfurrow_gpu.so; do
    [[ -e $build/$part ]] || die "$build/$part is missing: scripts/build.sh --portable furrow furrow_gpu terrain_gpu"
  done
  work=$(mktemp -d)
  trap 'rm -rf -- "'"$work"'"' EXIT
  to=$work/gpu_check
  mkdir -p "$to"/{program,emulation,lib,share/furrow,openmpi/bin,openmpi/share}
  cp -- "${BASH_SOURCE[0]}" "$to/gpu_check.sh"
  install -s "$build"/{furrow,libfurrow_gpu.so,gpu_emulation/terrain_gpu} "$to/program"
  install -s "$build/gpu_emulation/libfurrow_gpu.so" "$to/emulation"
  ln "$to"/program/{furrow,terrain_gpu} "$to/emulation"
  (cd -- "$root" && find rigs tire/data terrain/data vehicle/data \( -name '*.json' -o -name '*.csv' \) \
    -exec cp --parents -t "$to/share/furrow" {} +)

  # Of Open MPI's plugins those that need no further libraries.
  local prefix plugins
  prefix=$(ompi_info --parsable --path prefix | cut -d: -f3)
  plugins=$(ompi_info --parsable --path pkglibdir | cut -d: -f3)
  cp -L -- "$(command -v mpirun)" "$to/openmpi/bin/mpirun"
  cp -r -- "$prefix/share/openmpi" "$to/openmpi/share/"
  mkdir -p "$to/openmpi/${plugins#"$prefix"/}"
  libraries_of "$to"/program/* "$to/openmpi/bin/mpirun" "$plugins"/mca_pmix_*.so >"$work/libraries"
  for part in "$plugins"/mca_*.so; do
    if ! libraries_of "$part" | grep -qvxFf "$work/libraries"; then
      cp -- "$part" "$to/openmpi/${plugins#"$prefix"/}/"
    fi
  done
  xargs -a "$work/libraries" cp -L -t "$to/lib"

  say 'settling the bed'
  lattice >"$work/lattice.csv"
  set_up "$to" emulation "$work"
  "${furrow[@]}" bench grains --quiet --bed "$work/lattice.csv" --settle 2 --warm 0 --steps 1 --threads "$(nproc)" \
    --save-bed "$to/bed.csv" >"$work/settled.json"
  say 'hashes of the emulation'
  for part in mindlin rolling hertz_tanh; do
    printf '%s %s\n' "$part" "$(hash_of "$to/bed.csv" "$part")" | tee -a "$to/hashes" >&2
  done
  tar -C "$work" -czf "$file" gpu_check
  say "$file: $(($(stat -c %s -- "$file") >> 20)) MiB"
}

# ---- in the bundle ---------------------------------------------------------------------------------------------------

# set_up BUNDLE FOLDER WORK: how the programs of a folder of the bundle are called. Only they see its libraries.
set_up() {
  with=(env "LD_LIBRARY_PATH=$1/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" "OPAL_PREFIX=$1/openmpi"
    "FURROW_MPIRUN=$1/openmpi/bin/mpirun" "FURROW_HOME=$1/share/furrow" "XDG_CACHE_HOME=$3/cache" "HOME=$3" "TMPDIR=$3"
    OMPI_MCA_pml=ob1 "OMPI_MCA_btl=self,vader" OMPI_MCA_plm=isolated)
  furrow=("${with[@]}" "$1/$2/furrow")
  tests=("${with[@]}" "$1/$2/terrain_gpu")
}

# hash_of BED CASE: of the grains after 1,000 steps.
hash_of() {
  local options=()
  case $2 in
    rolling) options=(--rolling-friction 0.1) ;;
    hertz_tanh) options=(--law hertz_tanh) ;;
  esac
  "${furrow[@]}" bench grains --quiet --device gpu --bed "$1" --warm 0 --steps 1000 "${options[@]}" |
    awk -F'"' '/state_hash/ {print $4}'
}
compare() {
  local found expected
  found=$(hash_of "$here/bed.csv" "$1")
  expected=$(awk -v name="$1" '$1 == name {print $2}' "$here/hashes")
  printf '{"state_hash": "%s", "of_the_emulation": "%s"}\n' "$found" "$expected"
  [[ $found == "$expected" ]]
}

# tiles COUNT: the bed, COUNT times along x.
tiles() {
  awk -F, -v count="$1" 'NR == 1 {print; next}
    {x[NR] = $1; rest[NR] = $2 "," $3}
    END {for (t = 0; t < count; ++t) for (k = 2; k <= NR; ++k) printf "%.9f,%s\n", x[k] + t, rest[k]}' "$here/bed.csv"
}
# A bed of tiles for a bin with walls at its ends and its middle at y = 0.
between_walls() {
  awk -F, -v end="$1" -v OFS=, 'NR == 1 {print; next}
    $1 > 0.0061 && $1 < end - 0.0061 {print $1, sprintf("%.9f", $2 - 0.3), $3}'
}

quoted() {
  local text=${1//\\/\\\\}
  text=${text//\"/\\\"} text=${text//$'\n'/\\n}
  printf '"%s"' "${text//[[:cntrl:]]/ }"
}
# stage NAME SECONDS COMMAND...: runs the command, and writes the JSON file anew with its result.
stage() {
  local name=$1 limit=$((patience * $2)) begin=$SECONDS code=0 result
  shift 2
  ((limit <= deadline - SECONDS)) || limit=$((deadline - SECONDS))
  if ((limit < 5)); then
    code=-1 result='"no time was left"'
  else
    say "$name"
    timeout -k 5 "$limit" "$@" >"$work/out" 2>"$work/err" </dev/null || code=$?
    result=$(<"$work/out")
    if [[ $result != \{*\} ]]; then result=$(quoted "$(tail -n 60 "$work/out" "$work/err")"); fi
  fi
  ((code == 0)) || { failed=1; say "$name: exit code $code"; }
  stages+="${stages:+,}
{\"stage\": \"$name\", \"exit_code\": $code, \"seconds\": $((SECONDS - begin)), \"result\": $result}"
  printf '{"mode": "%s", "emulated": %s, "all_passed": %s, "stages": [%s\n]}\n' "$mode" "$emulated" \
    "$([[ -z $failed ]] && echo true || echo false)" "$stages" >"$out/$mode.json.part"
  mv -- "$out/$mode.json.part" "$out/$mode.json"
}
# A tool of CUDA.
cuda() {
  local tool=$1
  shift
  command -v "$tool" >/dev/null || PATH=$PATH:/usr/local/cuda/bin
  "$tool" "$@"
}

check() {
  local few=10 many=128 steps=1000 warm=0.2 t threads rig=(--set terrain.bed="$work/rig.csv" --set terrain.length=10)
  if [[ $emulated == true ]]; then
    few=1 many=2 steps=10 warm=0.02 rig=(--set terrain.radius=0.03 --set terrain.layers=4 --set terrain.length=6.5)
  fi
  local bench=("${furrow[@]}" bench grains --device gpu --warm $((steps / 10)))
  stage versions 20 "$self" versions
  for t in mindlin rolling hertz_tanh; do stage "hash_$t" 60 "$self" compare "$t"; done
  tiles "$few" >"$work/few.csv"
  between_walls "$few" <"$work/few.csv" >"$work/rig.csv"
  for t in mindlin hertz_tanh; do
    stage "speed_$t" 30 "${bench[@]}" --bed "$work/few.csv" --law "$t" --steps "$steps"
  done
  stage speed_rolling 30 "${bench[@]}" --bed "$work/few.csv" --rolling-friction 0.1 --steps "$steps"
  tiles "$many" >"$work/many.csv"
  stage speed_many 60 "${bench[@]}" --bed "$work/many.csv" --steps "$steps"
  rm -f -- "$work/many.csv"
  # One test asks for the emulation by name.
  stage unit_tests 60 "${tests[@]}" --gtest_brief=1 --gtest_filter=-GpuGrains.names_itself_an_emulation
  stage rig 90 "${furrow[@]}" bench rig --scenario drawbar_pull.json --set terrain.device=gpu "${rig[@]}" \
    --warm "$warm" --steps 2500
  head -n 2001 "$here/bed.csv" >"$work/small.csv"
  for t in memcheck racecheck; do
    [[ $emulated == true ]] || stage "$t" 40 "$self" cuda compute-sanitizer --tool "$t" --target-processes all \
      --error-exitcode 9 "${bench[@]}" --bed "$work/small.csv" --steps 20
  done
  [[ $emulated == true ]] || stage counters 40 "$self" cuda ncu --clock-control none --target-processes all \
    --kernel-name-base demangled -k regex:PairKernel --launch-skip 20 --launch-count 1 --section SpeedOfLight \
    --section MemoryWorkloadAnalysis --section Occupancy --section LaunchStats \
    "${bench[@]}" --bed "$work/few.csv" --steps 50
  threads=$(nproc)
  for ((t = 1; t <= threads; t *= 2)); do
    stage "processor_$t" 20 "${furrow[@]}" bench grains --bed "$work/few.csv" --threads "$t" --warm 5 \
      --steps $((20 * t))
  done
}

bed() {
  local keys=(--set terrain.device=gpu --set terrain.radius=0.0025 --set terrain.layers=40 --set terrain.length=4
    --set terrain.tile=0.5 --set terrain.substeps=2 --set run.end=0.6 --set run.average_from=0.4)
  if [[ $emulated == true ]]; then
    keys=(--set terrain.device=gpu --set terrain.radius=0.03 --set terrain.layers=4 --set terrain.length=1.4
      --set run.end=0.02 --set run.average_from=0.01)
  fi
  stage settle 110 "${furrow[@]}" bed drawbar_pull.json "${keys[@]}"
  stage run 170 "${furrow[@]}" run drawbar_pull.json "${keys[@]}" --set output.frame_interval=0 \
    --set checkpoint.interval=0 --set checkpoint.at_end=false --out "$work/run" --no-plots
  stage series 10 tail -n 400 "$work/run/timeseries.csv"
  stage summary 10 cat "$work/run/summary.json"
}

versions() {
  if [[ $emulated == false ]]; then
    nvidia-smi --query-gpu=name,driver_version,memory.total,clocks.max.sm,clocks.max.mem --format=csv
  fi
  uname -srm
  nproc
  awk -F': ' '/model name/ {print $2; exit}' /proc/cpuinfo
  "${furrow[@]}" --version
  "${furrow[@]}" validate drawbar_pull.json --set terrain.device=gpu | awk '/GPU/'
}

mode=${1:-}
case $mode in
  bundle) shift; bundle "$@" ;;
  check | bed)
    if (($# < 2 || $# > 3)) || [[ ${3:---emulated} != --emulated ]]; then usage >&2; exit 2; fi
    [[ -d $here/program ]] || die 'unpack the bundle, and call its gpu_check.sh'
    emulated=false folder=program patience=1
    if (($# == 3)); then emulated=true folder=emulation patience=6; fi
    mkdir -p -- "$2"
    out=$(realpath -- "$2") work=$(mktemp -d) self=$here/gpu_check.sh stages='' failed=''
    trap 'rm -rf -- "$work"' EXIT
    export GPU_CHECK_EMULATED=$emulated GPU_CHECK_FOLDER=$folder GPU_CHECK_WORK=$work
    deadline=$((SECONDS + patience * 285))
    set_up "$here" "$folder" "$work"
    "$mode"
    say "$out/$mode.json"
    [[ -z $failed ]]
    ;;
  versions | compare | cuda)  # parts of stages
    emulated=$GPU_CHECK_EMULATED
    set_up "$here" "$GPU_CHECK_FOLDER" "$GPU_CHECK_WORK"
    "$@"
    ;;
  -h | --help) usage ;;
  *) usage >&2; exit 2 ;;
esac
