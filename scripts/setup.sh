#!/usr/bin/env bash
# Installs the Debian packages that Furrow is built from and runs with. Safe to repeat: with nothing missing it
# touches nothing and asks nothing.
set -euo pipefail

# What is needed: "package  purpose". a|b: any of the two will do, the first is what gets installed.
base_packages() { cat <<'LIST'
g++                                       C++20 compiler
cmake                                     build system, 3.25 or newer
ninja-build                               build system
libopenmpi-dev                            messages between ranks
openmpi-bin                               mpirun
libhwloc-dev                              cores and their affinity
libeigen3-dev                             small matrices
libsuitesparse-dev                        sparse Cholesky factorization (CHOLMOD)
libopenblas-serial-dev|libopenblas-pthread-dev|libopenblas-openmp-dev  dense kernels under CHOLMOD
libceres-dev                              nonlinear least squares: calibrations
libhdf5-dev                               result files and checkpoints
nlohmann-json3-dev                        reading JSON
libvalijson-dev                           checking scenarios against the schema
libcli11-dev                              command line
libfmt-dev                                text formatting
libgtest-dev                              tests
libbenchmark-dev                          benchmarks
python3-h5py                              plots: reading result files
python3-matplotlib                        plots
LIST
}
liggghts_packages() { cat <<'LIST'
libliggghts-dev                           distributed DEM engine
liggghts                                  comparisons of tests/peers
LIST
}
vtk_packages() { cat <<'LIST'
python3-paraview                          its VTK reads XDMF, which python3-vtk9 does not: one test
LIST
}

python_packages() { cat <<'LIST'
python3-pandas                            tables of scripts/python
python3-xarray                            data sets of scripts/python
python3-h5netcdf                          xarray's reader of HDF5
python3-nbclient                          runs the notebooks, for a test
python3-ipykernel                         likewise
python3-pip                               installs the package, for a test
mypy                                      checks the types of scripts/python, for a test
LIST
}

docs_packages() { cat <<'LIST'
python3-sphinx                            scripts/docs.sh: the site
python3-myst-parser                       its pages are Markdown
furo                                      its looks
doxygen                                   reads the headers
python3-breathe                           puts them into the site
libjs-katex                               formulas without the network
LIST
}

usage() { cat <<'HELP'
usage: scripts/setup.sh [--liggghts] [--vtk] [--python] [--docs] [-y]
Installs the missing Debian packages, after saying which and how large, and asking.
  --liggghts  also LIGGGHTS (optional: distributed terrain, comparisons of tests/peers)
  --vtk       also the VTK that reads XDMF (needed by one test only; large)
  --python    also what the Python package of scripts/python needs
  --docs      also what builds the documentation site (scripts/docs.sh)
  -y, --yes   do not ask; nor is asked where CI is set, or as root without a terminal
  --check     install nothing; exit 0 if nothing is missing, 1 if something is
HELP
}

say() { printf 'setup: %s\n' "$*" >&2; }
die() { say "error: $*"; exit 1; }

lists=(base) assume_yes=false check_only=false
while (($#)); do
  case $1 in
    --liggghts) lists+=(liggghts) ;;
    --vtk) lists+=(vtk) ;;
    --python) lists+=(python) ;;
    --docs) lists+=(docs) ;;
    -y|--yes) assume_yes=true ;;
    --check) check_only=true ;;
    -h|--help) usage; exit 0 ;;
    *) usage >&2; die "unknown option '$1'" ;;
  esac
  shift
done

wanted() { local list; for list in "${lists[@]}"; do "${list}_packages"; done; }

is_debian_like() {
  command -v apt-get >/dev/null && command -v dpkg-query >/dev/null || return 1
  [[ -r /etc/os-release ]] || return 1
  ( . /etc/os-release; [[ " ${ID:-} ${ID_LIKE:-} " == *" debian "* ]] )
}

if ! is_debian_like; then
  say 'this is not a Debian system, so nothing is installed. Needed, by the names Debian gives them:'
  wanted | sed 's/^/  /' >&2
  say 'install these by the means of this system, then set FURROW_NO_SETUP=1 and build'
  exit 1
fi

# Prints the packages of the lists that are not installed.
missing_packages() {
  local alternatives package installed
  installed=" $(dpkg-query -W -f '${db:Status-Abbrev}${Package}\n' 2>/dev/null | sed -n 's/^.i //p' | tr '\n' ' ')"
  while read -r alternatives _; do
    for package in ${alternatives//|/ }; do
      [[ $installed == *" $package "* ]] && continue 2
    done
    echo "${alternatives%%|*}"
  done < <(wanted)
}

mapfile -t missing < <(missing_packages)
if ((${#missing[@]} == 0)); then
  $check_only || say 'nothing is missing'
  exit 0
fi
if $check_only; then
  say "missing: ${missing[*]}"
  exit 1
fi

as_root=()
if ((EUID != 0)); then
  command -v sudo >/dev/null ||
    die "not root, and there is no sudo. As root: apt-get update &&" \
      "apt-get install --no-install-recommends ${missing[*]}"
  as_root=(sudo)
  say 'not root: apt-get is run through sudo'
fi
apt_options=(--no-install-recommends -o APT::Install-Suggests=false)
apt_get() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive LC_ALL=C apt-get "$@"; }
# The same question without root and without the lock.
simulate() { LC_ALL=C apt-get "${apt_options[@]}" -o Debug::NoLocking=1 "$@" install "${missing[@]}"; }

updated=false
update() {
  say 'updating the package lists'
  apt_get update -qq >&2 || die 'apt-get update failed'
  updated=true
}

simulate -qq -s >/dev/null 2>&1 || update
plan=$(simulate -qq -s) || die "apt-get cannot install: ${missing[*]}"
mapfile -t to_install < <(sed -n 's/^Inst \([^ ]*\) .*(\([^ ]*\) .*/\1=\2/p' <<<"$plan")
download_bytes=$(simulate -qq -y --print-uris | awk '{sum += $3} END {printf "%.0f", sum}')
installed_kib=$(apt-cache show "${to_install[@]}" | awk '
  $1 == "Package:" {package = $2} $1 == "Installed-Size:" {size[package] = $2}
  END {for (p in size) sum += size[p]; printf "%.0f", sum}')
say "missing: ${missing[*]}"
say "with what they depend on: ${#to_install[@]} packages, $((download_bytes / 1000000)) MB to download," \
  "$((installed_kib * 1024 / 1000000)) MB on disk"

if ! $assume_yes && [[ -z ${CI:-} ]]; then
  if [[ -t 0 ]]; then
    read -r -p 'setup: install them? [Y/n] ' answer
    [[ $answer =~ ^([yY].*)?$ ]] || die 'nothing was installed'
  elif ((EUID != 0)); then
    die 'nobody to ask, and not root: run scripts/setup.sh -y'
  fi
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
# Hundreds of small packages: one sync at the end instead of one per file saves minutes.
install() {
  apt_get install -y -qq "${apt_options[@]}" -o Dpkg::Use-Pty=0 -o Dpkg::Options::=--force-unsafe-io \
    "${missing[@]}" >"$log" 2>&1 </dev/null && sync
}
say 'installing'
start=$SECONDS
if ! install; then
  # Old package lists name versions that the mirror no longer has.
  if $updated || { update; ! install; }; then
    tail -n 20 "$log" >&2
    die 'apt-get install failed'
  fi
fi
say "installed in $((SECONDS - start)) s"
