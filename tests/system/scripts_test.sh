#!/usr/bin/env bash
# The scripts a newcomer types, on a miniature project in a folder with a space in its name: scripts/furrow, build.sh,
# test.sh and setup.sh, the last with stand-ins for Debian's tools. Prints each failure; exit status 1 if there was one.
set -uo pipefail
repository=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.." && pwd -P)
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
unset OMPI_COMM_WORLD_RANK PMIX_RANK PMI_RANK CI CTEST_OUTPUT_ON_FAILURE
export FURROW_NO_SETUP=1

failures=0
check() {  # check NAME CONDITION...
  local name=$1; shift
  if "$@"; then echo "ok: $name"; else echo "FAILED: $name"; failures=$((failures + 1)); show; fi
}
show() { sed 's/^/  stdout: /' "$work/out"; sed 's/^/  stderr: /' "$work/err"; echo "  status: $status"; }
run() { "$@" >"$work/out" 2>"$work/err" </dev/null; status=$?; }
out_is() { [[ $(<"$work/out") == "$1" ]]; }
err_is() { [[ $(<"$work/err") == "$1" ]]; }
err_has() { grep -qF -- "$1" "$work/err"; }
err_has_not() { ! err_has "$1"; }
status_is() { ((status == $1)); }
fails() { ((status != 0)); }

# A project with the same entry points, quick to build.
project="$work/a checkout"
mkdir -p -- "$project/scripts" "$work/elsewhere"
cp -- "$repository"/scripts/{furrow,build.sh,test.sh,setup.sh} "$project/scripts/"
cp -- "$repository/CMakePresets.json" "$project/"
cat >"$project/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(miniature LANGUAGES C)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
add_executable(furrow main.c)
enable_testing()
add_test(NAME runs COMMAND furrow)
set_tests_properties(runs PROPERTIES LABELS unit)
add_test(NAME refuses COMMAND furrow --exit 2)
set_tests_properties(refuses PROPERTIES LABELS broken)
CMAKE
cat >"$project/main.c" <<'C'
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
int main(int count, char** arguments) {
  char folder[4096];
  printf("%s", getcwd(folder, sizeof folder));
  for (int i = 1; i < count; ++i) printf("|%s", arguments[i]);
  printf("\n");
  return count > 2 && !strcmp(arguments[1], "--exit") ? atoi(arguments[2]) : 0;
}
C
furrow="$project/scripts/furrow"

cd -- "$work/elsewhere"
run "$furrow" run 'a file.json' --set 'a.b=1 2'
check 'furrow builds, and runs where the caller stands' out_is "$work/elsewhere|run|a file.json|--set|a.b=1 2"
check 'what the build says goes to stderr' err_has 'build: configuring'
run "$furrow" --exit 75
check "furrow's exit status is the program's" status_is 75
check 'nothing is said when all is up to date' err_is ''
ln -s -- "$furrow" "$work/linked"
run "$work/linked"
check 'furrow can be called through a link' out_is "$work/elsewhere"

run "$project/scripts/test.sh"
check 'test.sh passes when the tests pass' status_is 0
check "test.sh ends with ctest's count" grep -q '^100% tests passed, 0 tests failed out of 1' "$work/out"
run "$project/scripts/test.sh" --label broken
check 'test.sh fails when a test fails' fails
run "$project/scripts/test.sh" --label nothing
check 'test.sh fails when there is no test' fails
run "$project/scripts/test.sh" --what
check 'test.sh refuses an unknown option' err_has "unknown option '--what'"

cp -- "$project/main.c" "$work/main.c"
sleep 0.01
echo 'this is no C' >>"$project/main.c"
run "$furrow"
check 'a source that does not compile stops furrow' fails
check 'nothing of that goes to stdout' out_is ''
check 'the compiler is quoted' err_has 'main.c:'
OMPI_COMM_WORLD_RANK=1 run "$furrow"
check 'a rank under a launcher does not build' out_is "$work/elsewhere"
mv -- "$work/main.c" "$project/main.c"; touch -- "$project/main.c"

mv -- "$project" "$work/moved"
run "$work/moved/scripts/furrow" moved
check 'a moved checkout builds afresh' out_is "$work/elsewhere|moved"
check 'and says so' err_has 'starting afresh'

# setup.sh: stand-ins for dpkg-query and apt-get that note how they are called.
unset FURROW_NO_SETUP
setup="$repository/scripts/setup.sh"
fake="$work/fake"; mkdir -p -- "$fake"
cat >"$fake/apt-get" <<'SH'
#!/bin/sh
echo "apt-get $*" >>"$FAKE_LOG"
case "$*" in
  *--print-uris*) echo "'uri' g++_1.deb 3000000 hash" ;;
  *" -s "*) echo 'Inst g++ (1 Debian:12 [amd64])' ;;
esac
SH
printf '#!/bin/sh\nprintf "Package: g++\\nInstalled-Size: 20000\\n"\n' >"$fake/apt-cache"
printf '#!/bin/sh\ncat "$FAKE_INSTALLED"\n' >"$fake/dpkg-query"
printf '#!/bin/sh\necho "sudo $*" >>"$FAKE_LOG"; exec "$@"\n' >"$fake/sudo"
printf '#!/bin/sh\n' >"$fake/sync"
chmod +x "$fake"/*
export FAKE_LOG="$work/apt.log" FAKE_INSTALLED="$work/installed"
apt_calls() { cat "$FAKE_LOG" 2>/dev/null; }
has_installed() { apt_calls | grep -q '^apt-get install -y .*--no-install-recommends .*g++'; }
has_not_called() { ! apt_calls | grep -q .; }
has_not_installed() { ! has_installed; }
path=$PATH
all=$(sed -n '/^base_packages/,/^LIST/{s/^\([a-z0-9+.-]*\)[| ].*/\1/p}' "$setup" | grep -v '^base_packages$')

if [[ -r /etc/os-release ]] && grep -qE '^ID(_LIKE)?=.*debian' /etc/os-release; then
  PATH="$fake:$path"
  sed 's/^/ii /' <<<"$all" >"$FAKE_INSTALLED"
  run "$setup"
  check 'nothing missing: no apt at all' has_not_called
  check 'nothing missing: success' status_is 0
  sed -i '/^ii g++$/d' "$FAKE_INSTALLED"
  run "$setup" --check
  check '--check only tells' has_not_called
  check '--check tells what is missing' err_is 'setup: missing: g++'
  run "$setup" -y
  check 'the missing are installed, without recommended ones' has_installed
  check 'how many and how large is said before' err_has '1 packages, 3 MB to download, 20 MB on disk'
  rm -f -- "$FAKE_LOG"
  CI=true run "$setup"
  check 'where CI is set nobody is asked' has_installed
  sed -i 's/^ii libopenblas-serial-dev$/ii libopenblas-pthread-dev/' "$FAKE_INSTALLED"
  run "$setup" --check
  check 'any BLAS of the kind will do' err_is 'setup: missing: g++'
  if ((EUID == 0)); then
    rm -f -- "$FAKE_LOG"
    run "$setup"
    check 'root without a terminal is not asked' has_installed
    if command -v setpriv >/dev/null; then
      : >"$FAKE_LOG"; chmod 0777 "$work"; chmod 0666 "$FAKE_LOG"
      cp -- "$setup" "$work/setup.sh"; chmod 0755 "$work/setup.sh" "$fake"
      run setpriv --reuid=65534 --regid=65534 --clear-groups "$work/setup.sh"
      check 'a user without a terminal is told, not surprised' err_has 'run scripts/setup.sh -y'
      check 'and nothing is installed' has_not_installed
      run setpriv --reuid=65534 --regid=65534 --clear-groups "$work/setup.sh" -y
      check 'sudo is announced' err_has 'through sudo'
      check 'and used' grep -q '^sudo env .*apt-get install' "$FAKE_LOG"
    fi
  fi
fi

other="$work/other"; mkdir -p -- "$other"
for tool in bash env cat sed grep readlink dirname; do ln -s -- "$(PATH=$path command -v "$tool")" "$other/$tool"; done
PATH="$other" run "$setup"
PATH=$path
check 'off Debian: stops' fails
check 'off Debian: lists what is needed' err_has 'libsuitesparse-dev'

((failures == 0)) || { echo "$failures checks failed"; exit 1; }
