#!/usr/bin/env bash
# Builds the documentation site from the pages of all rooms and of scripts/docs/.
set -euo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd -P)

usage() { cat <<'HELP'
usage: scripts/docs.sh [--out DIR]
Builds the documentation site and prints the path of its first page. Any warning is an error. The pages need no network.
Installs the missing Debian packages (scripts/setup.sh --docs), unless FURROW_NO_SETUP is set.
  --out DIR  folder for the site (html/) and what it is made from (default: build/docs)
The reference pages are made with the program that FURROW names (default: build/furrow, which is built
if it is missing).
HELP
}
say() { printf 'docs: %s\n' "$*" >&2; }
die() { say "error: $*"; exit 1; }

out=$root/build/docs
while (($#)); do
  case $1 in
    --out) (($# > 1)) || die '--out needs a folder'; out=$(realpath -m -- "$2"); shift ;;
    -h|--help) usage; exit 0 ;;
    *) usage >&2; die "unknown option '$1'" ;;
  esac
  shift
done

[[ -n ${FURROW_NO_SETUP:-} ]] || "$root/scripts/setup.sh" --docs >&2
for tool in sphinx-build doxygen; do
  command -v "$tool" >/dev/null || die "$tool is missing, expected the packages of scripts/setup.sh --docs"
done
program=${FURROW:-$root/build/furrow}
[[ -x $program ]] || "$root/scripts/build.sh" furrow >&2

export PYTHONDONTWRITEBYTECODE=1 FURROW_DOXYGEN_XML=$out/doxygen/xml
mkdir -p -- "$out"
/usr/bin/python3 "$root/scripts/docs/stage.py" "$out/source" --root "$root"
/usr/bin/python3 "$root/scripts/docs/reference.py" "$out/source/reference" --root "$root" --program "$program"
/usr/bin/python3 "$root/scripts/docs/doxyfile.py" --root "$root" --out "$out/doxygen" |
  doxygen - >"$out/doxygen.log" 2>&1 ||
  { tail -n 20 "$out/doxygen.log" >&2; die 'doxygen failed'; }
sphinx-build -W --keep-going -q -j auto -d "$out/doctrees" -c "$root/scripts/docs" "$out/source" "$out/html" ||
  die 'the site was not built: see above'
printf '%s\n' "$out/html/index.html"
