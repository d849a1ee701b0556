#!/usr/bin/env bash
# The README's commands, word for word, on a bare Debian 12: debootstrap makes a minimal system in a temporary folder,
# a clean clone of this repository goes into it, and the commands run there as a new user would run them.
# Prints a report in JSON. Exit status: 0 all well, 1 a command failed or took longer than its budget, 77 cannot run
# here.
set -euo pipefail
here=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")" && pwd -P)
repository=$(cd -- "$here/../.." && pwd -P)
readonly setup_budget_s=180 build_budget_s=600 small_budget_s=180  # README.md: about ten minutes

say() { printf 'fresh_debian: %s\n' "$*" >&2; }
usage() { cat <<'HELP'
usage: tests/system/fresh_debian.sh [--release NAME] [--archive FILE] [--short] [--keep] [--results DIR]
Needs root, debootstrap, git and the network (the mirror is that of this machine's apt configuration).
  --release NAME the name of another release, for example trixie: Debian 13 (default: bookworm, Debian 12)
  --archive FILE the source archive of a release instead of a clone; `ninja -C build package_source` makes it
  --short        the commands of the tutorial instead of the tests
  --keep         leave the system's folder for a look inside
  --results DIR  copy the runs' results there
HELP
}

short=false keep=false results='' release=bookworm archive=''
all=("$@")
while (($#)); do
  case $1 in
    --release) release=$2; shift ;;
    --archive) archive=$(realpath -- "$2"); shift ;;
    --short) short=true ;;
    --keep) keep=true ;;
    --results) results=$(realpath -m -- "$2"); shift ;;
    -h|--help) usage; exit 0 ;;
    *) usage >&2; exit 1 ;;
  esac
  shift
done
((EUID == 0)) || { say 'skipped: needs root'; exit 77; }
for program in debootstrap git apt-get unshare; do
  command -v "$program" >/dev/null || { say "skipped: needs $program"; exit 77; }
done

# Mounts and processes live in namespaces of their own and are gone with the last process there. The folder is removed
# out here, where nothing is mounted on it.
if [[ -z ${FURROW_FRESH_FOLDER:-} ]]; then
  FURROW_FRESH_FOLDER=$(mktemp -d "${TMPDIR:-/tmp}/furrow-fresh.XXXXXX")
  export FURROW_FRESH_FOLDER
  inside=
  cleanup() {
    if [[ -n $inside ]]; then kill -KILL "$inside" 2>/dev/null || true; wait "$inside" || true; fi
    if $keep; then say "kept: $FURROW_FRESH_FOLDER"; else rm -rf --one-file-system -- "$FURROW_FRESH_FOLDER"; fi
  }
  trap cleanup EXIT
  trap 'exit 130' INT
  trap 'exit 143' TERM HUP
  unshare --mount --propagation private --pid --fork --kill-child bash "$here/fresh_debian.sh" "${all[@]}" &
  inside=$!
  status=0
  wait "$inside" || status=$?
  inside=
  exit "$status"
fi
trap 'say "line $LINENO failed"' ERR
work=$FURROW_FRESH_FOLDER
system=$work/system
checkout='/srv/furrow checkout'  # a path with a space
log=$work/commands.log

# 1. The machine. Debian's archives as this machine's apt knows them: URI, suite, component.
archives=$(apt-get indextargets --format '$(ORIGIN)|$(REPO_URI)|$(RELEASE)|$(COMPONENT)' 'Created-By: Packages' |
  awk -F'|' '$1 == "Debian" && $3 ~ /^bookworm/ {print $2, $3, $4}' | sort -u)
archives=${archives//bookworm/$release}
mirror=$(awk -v release="$release" '$2 == release {print $1; exit}' <<<"$archives")
[[ -n $mirror ]] || { say "skipped: this machine's apt knows no Debian 12 archive (apt-get update first?)"; exit 77; }
say "making a minimal Debian ($release)"
debootstrap --variant=minbase "$release" "$system" "$mirror" >"$work/debootstrap.log" 2>&1 ||
  { tail -n 20 "$work/debootstrap.log" >&2; exit 1; }
sed 's/^/deb /' <<<"$archives" >"$system/etc/apt/sources.list"
apt-config dump | grep -E '^Acquire::(http|https|Check-|Retries|ForceIPv)' >"$system/etc/apt/apt.conf.d/90host" || true
if [[ $archives == *https:* && -r /etc/ssl/certs/ca-certificates.crt ]]; then
  install -D /etc/ssl/certs/ca-certificates.crt "$system/etc/ssl/certs/ca-certificates.crt"
fi
cp -L /etc/resolv.conf /etc/hosts "$system/etc/"
mount -t proc proc "$system/proc"
mount -t sysfs -o ro sysfs "$system/sys"
mount --rbind /dev "$system/dev"
mount -t tmpfs -o mode=1777,size=50% tmpfs "$system/tmp"
if [[ -n $archive ]]; then
  mkdir -- "$system$checkout"
  tar -xf "$archive" -C "$system$checkout" --strip-components=1
  commit=$(basename -- "$archive")
else
  git -c safe.directory='*' clone --quiet --no-hardlinks -- "$repository" "$system$checkout"
  commit=$(git -c safe.directory='*' -C "$system$checkout" rev-parse --short HEAD)
fi

# 2. The commands: what is in the README's code block behind the mark.
readme_command() {
  awk -v mark="<!-- command: $1 -->" '$0 == mark {found = 1; next} found && /^```/ {if (inside) exit; inside = 1; next}
    inside {print}' "$system$checkout/README.md"
}
installed() {
  chroot "$system" dpkg-query -W -f '${Installed-Size}\n' |
    awk '{n++; kib += $1} END {printf "%d %d\n", n, kib * 1.024e-3}'
}
now() { echo "${EPOCHREALTIME/,/.}"; }
elapsed() { awk -v a="$1" -v b="$2" 'BEGIN {printf "%.1f", b - a}'; }

# The tutorial's blocks of commands, but those that take long (tests/system/docs_tutorial.py leaves out the build too).
tutorial_commands() {
  awk '/^```/ {inside = !inside && $0 == "```sh" && !skip; skip = 0; next} inside {print; next}
    {skip = /^<!-- not run: (takes|as root)/}' "$system$checkout/scripts/docs/tutorial.md"
}
# Runs a command in the new system; its time goes to wall, the times at which packages and build were done to
# setup_done and build_done.
run() {
  local name=$1 command status=1 began line
  if [[ $name == tutorial ]]; then command="set -e; $(tutorial_commands)"; else command=$(readme_command "$name"); fi
  [[ -n $command ]] || { say "README.md has no command marked '$name'"; exit 1; }
  say "$name: $command"
  began=$(now) setup_done=$began build_done=''
  while IFS= read -r line; do
    line=${line##*$'\r'}
    printf '%s\n' "$line" >>"$log"
    case $line in
      'setup: installed in'*) setup_done=$(now) ;;
      'build: done in'*) build_done=$(now) ;;
      'status: '*) status=${line#status: } ;;
      *) printf '  | %s\n' "$line" >&2 ;;
    esac
  done < <(chroot "$system" /usr/bin/env -i HOME=/root TERM=dumb LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin \
             http_proxy="${http_proxy:-}" https_proxy="${https_proxy:-}" \
             bash -c 'cd -- "$1" && eval "$2"; echo "status: $?"' bash "$checkout" "$command" 2>&1 </dev/null)
  build_done=${build_done:-$setup_done}
  setup_s=$(elapsed "$began" "$setup_done") build_s=$(elapsed "$setup_done" "$build_done")
  run_s=$(elapsed "$build_done" "$(now)")
  ((status == 0)) || { say "'$name' ended with status $status"; exit 1; }
}

read -r packages_before mb_before < <(installed)
run first_look
first=("$setup_s" "$build_s" "$run_s")
read -r packages mb < <(installed)

# The tutorial's line that starts the ranks by hand, as root and as a plain user.
by_hand=$(grep -m 1 '^mpirun ' "$system$checkout/scripts/docs/tutorial.md")
chroot "$system" useradd --create-home engineer
for user in root engineer; do
  line=$by_hand
  [[ $user == engineer ]] || line=${by_hand/#mpirun/mpirun --allow-run-as-root}
  say "$user: $line"
  chroot "$system" runuser -l "$user" -c "PATH=\"$checkout/scripts:\$PATH\" && $line" >>"$log" 2>&1 </dev/null ||
    { tail -n 20 "$log" >&2; say "failed as $user"; exit 1; }
done

tutorial_s=null test=(null null) tests=0
if $short; then
  run tutorial
  tutorial_s=$run_s
else
  run test
  tests=$(sed -n 's/.*tests passed, .* tests failed out of \([0-9]*\).*/\1/p' "$log" | tail -n 1)
  test=("$build_s" "$run_s")
fi
run drawbar_pull_small
if [[ -n $results ]]; then mkdir -p -- "$results" && cp -r "$system$checkout/results/." "$results/"; fi
pull=$(grep -hA1 '"drawbar_pull_N"' "$system$checkout"/results/drawbar_pull_small*/summary.json | tr -d '\n' || true)
pull_mean=$(sed -n 's/.*"mean": *\([-0-9.e+]*\).*/\1/p' <<<"$pull")

within() { awk -v s="$1" -v budget="$2" 'BEGIN {exit !(s <= budget)}' && echo true || echo false; }
compiler=$(sed -n 's/.*"compiler": *"\([^"]*\)".*/\1/p' \
  "$system$checkout"/results/drawbar_pull_small*/summary.json | head -n 1)
processor=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
cat <<JSON
{
  "made": {"commit": "$commit", "compiler": "$compiler", "processor": "$processor",
           "command": "tests/system/fresh_debian.sh$($short && echo ' --short')"},
  "release": "$release",
  "cores": $(nproc),
  "packages": {"before": $packages_before, "added": $((packages - packages_before))},
  "installed_MB": {"before": $mb_before, "added": $((mb - mb_before))},
  "setup_s": ${first[0]},
  "build_s": ${first[1]},
  "first_look_s": ${first[2]},
  "build_tests_s": ${test[0]},
  "test_s": ${test[1]},
  "tests": ${tests:-0},
  "tutorial_s": $tutorial_s,
  "drawbar_pull_small_s": $run_s,
  "drawbar_pull_small_N": ${pull_mean:-null},
  "within_budget": {"setup": $(within "${first[0]}" $setup_budget_s), "build": $(within "${first[1]}" $build_budget_s),
                    "drawbar_pull_small": $(within "$run_s" $small_budget_s)}
}
JSON
[[ $(within "${first[0]}" $setup_budget_s)$(within "${first[1]}" $build_budget_s)$(
   within "$run_s" $small_budget_s) == truetruetrue ]] ||
  { say 'a budget was exceeded'; exit 1; }
