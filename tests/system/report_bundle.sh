#!/usr/bin/env bash
# The bundle of report.html made again from its sources is the one that is kept. Skipped (77) without npm or its
# registry.
set -euo pipefail
scripts=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../../scripts" && pwd -P)
command -v npm >/dev/null || exit 77
made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
npm ping >/dev/null 2>&1 || exit 77
"$scripts/report/build.sh" "$made"
diff -r "$scripts/python/furrow/page/bundle" "$made"
