#!/usr/bin/env bash
# Installs Furrow into a folder that may be moved, or mounted on other machines: one build for each instruction set.
set -euo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd -P)

usage() { cat <<'HELP'
usage: scripts/install.sh --prefix DIR [LEVEL ...]
       scripts/install.sh --deb DIR [LEVEL ...]
Builds furrow once for each LEVEL (into build-LEVEL/) and installs all of them into DIR, or makes a Debian package
of them there.
bin/furrow starts the build for the richest instruction set of the processor that it runs on.
  LEVEL  any -march= of the compiler, for example x86-64-v3, or "any" for its plainest processor
         (default: x86-64-v2 x86-64-v3 x86-64-v4; on other architectures: any)
HELP
}
say() { printf 'install: %s\n' "$*" >&2; }
die() { say "error: $*"; exit 1; }

prefix='' deb='' levels=() projects=''
while (($#)); do
  case $1 in
    --prefix) (($# > 1)) || die '--prefix needs a folder'; prefix=$(realpath -m -- "$2"); shift ;;
    --deb) (($# > 1)) || die '--deb needs a folder'; deb=$(realpath -m -- "$2"); shift ;;
    -h|--help) usage; exit 0 ;;
    -*) usage >&2; die "unknown option '$1'" ;;
    *) levels+=("$1") ;;
  esac
  shift
done
[[ -n $prefix || -n $deb ]] || { usage >&2; die '--prefix or --deb is missing'; }
if ((${#levels[@]} == 0)); then
  if [[ $(uname -m) == x86_64 ]]; then levels=(x86-64-v2 x86-64-v3 x86-64-v4); else levels=(any); fi
fi

for level in "${levels[@]}"; do
  build=$root/build-$level
  say "building for $level"
  cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DFURROW_NATIVE=OFF -DFURROW_LEVEL="$level" \
    -DFURROW_TESTS=OFF >"$build.log" 2>&1 || { cat "$build.log" >&2; die 'cmake failed'; }
  ninja -C "$build" furrow >"$build.log" 2>&1 || { cat "$build.log" >&2; die 'compilation failed'; }
  projects+="$build;furrow;program;/;"
  if [[ -n $prefix ]]; then
    cmake --install "$build" --component program --prefix "$prefix" >"$build.log" 2>&1 ||
      { cat "$build.log" >&2; die 'cannot be installed'; }
  fi
  rm -f "$build.log"
done
[[ -z $prefix ]] || say "$prefix/bin/furrow"
[[ -n $deb ]] || exit 0

cpack --config "$build/CPackConfig.cmake" -G DEB -B "$deb" \
    -D "CPACK_INSTALL_CMAKE_PROJECTS=${projects%;}" >"$build.log" 2>&1 ||
  { cat "$build.log" >&2; die 'cannot be packed'; }
rm -rf -- "$build.log" "$deb/_CPack_Packages"
say "$(echo "$deb"/furrow_*.deb)"
