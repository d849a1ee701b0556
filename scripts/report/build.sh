#!/usr/bin/env bash
# Makes the bundle of report.html, scripts/python/furrow/page/bundle/, from source/. Needs Node.js 20, npm and its
# registry.
# usage: build.sh [FOLDER]   FOLDER: where the files are written instead
set -euo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd -P)
out=${1:-$here/../python/furrow/page/bundle}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r "$here"/{package.json,package-lock.json,.npmrc,build.mjs,source} "$work"
cd "$work"
npm ci --ignore-scripts --no-audit --no-fund --loglevel=error
node build.mjs
mkdir -p "$out"
cp bundle/* "$out/"
