#!/usr/bin/env bash
# The image of scripts/cluster/Containerfile, of an installed tree of the build in $FURROW's folder: built without a
# daemon on a Debian 12 made by debootstrap, unpacked, and run by a user who is not root. Exit status: 0 all well, 1
# something failed, 77 cannot run here.
set -euo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.." && pwd -P)
build=$(dirname -- "${FURROW:-$root/build/furrow}")
say() { printf 'image: %s\n' "$*" >&2; }
failed() { tail -20 "$work/log" >&2; exit 1; }

((EUID == 0)) || { say 'skipped: needs root'; exit 77; }
for program in debootstrap buildah ch-run setpriv cmake; do
  command -v "$program" >/dev/null || { say "skipped: needs $program"; exit 77; }
done
work=$(mktemp -d "${TMPDIR:-/tmp}/furrow-image.XXXXXX")
trap 'rm -rf --one-file-system -- "$work"' EXIT
chmod 755 "$work"
store=(--storage-driver vfs --root "$work/store" --runroot "$work/run")

mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' | head -1)
say "Debian 12 from $mirror"
debootstrap --variant=minbase bookworm "$work/debian" "$mirror" >"$work/log" 2>&1 || failed
cp /etc/apt/apt.conf.d/* "$work/debian/etc/apt/apt.conf.d/" 2>/dev/null || true  # a proxy, where there is one
tar -C "$work/debian" --exclude=./dev --exclude=./proc --exclude=./sys -cf "$work/debian.tar" .
mkdir "$work/base" "$work/image"
mv "$work/debian.tar" "$work/base/"
printf 'FROM scratch\nADD debian.tar /\n' >"$work/base/Containerfile"
buildah bud --isolation chroot "${store[@]}" -t debian12 "$work/base" >"$work/log" 2>&1 || failed

say 'the image'
cmake --install "$build" --component program --prefix "$work/image/opt/furrow" >"$work/log"
buildah bud --isolation chroot "${store[@]}" --build-arg BASE=localhost/debian12 -t furrow \
  -f "$root/scripts/cluster/Containerfile" "$work/image" >"$work/log" 2>&1 || { tail -30 "$work/log" >&2; exit 1; }
container=$(buildah from "${store[@]}" localhost/furrow)
mounted=$(buildah mount "${store[@]}" "$container")
mkdir "$work/unpacked"
cp -a "$mounted/." "$work/unpacked/"
chmod 755 "$work/unpacked"

say 'a run by an ordinary user'
mkdir "$work/home"
cat >"$work/home/scenario.json" <<'JSON'
{"format_version": 1, "rig": {"type": "drawbar", "slip": 0.2, "angular_speed": 4.28, "ramp": 0.01},
 "tire": {"file": "hmmwv_layered.json", "rigid": true}, "terrain": {"engine": "rigid"},
 "run": {"step": 1e-4, "end": 0.02, "average_from": 0.01}, "output": {"series_interval": 1e-3, "frame_interval": 0.01}}
JSON
chown -R nobody "$work/home"
cd "$work/home"
setpriv --reuid=nobody --regid=nogroup --clear-groups env -i USER=nobody HOME="$work/home" \
  PATH=/opt/furrow/bin:/usr/bin:/bin ch-run --no-home --bind="$work/home:/mnt" --cd=/mnt "$work/unpacked" -- \
  furrow run scenario.json --out out >&2
test -s out/summary.json
ls out/*.png >/dev/null
say 'done'
