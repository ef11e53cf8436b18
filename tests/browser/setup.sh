#!/usr/bin/env bash
# Brings headless Chromium and what steers it from the npm registry into target/browser, at the versions of package.json.
# Says so and succeeds where Node.js or the packages cannot be had: tests/page.rs then skips itself.
set -euo pipefail
cd "$(dirname "$0")/../.."
browser="${CARGO_TARGET_DIR:-target}/browser"

if [ -f "$browser/ready" ] && cmp -s tests/browser/package.json "$browser/package.json"; then
    echo "browser: ready in $browser"
    exit 0
fi
if ! command -v npm >/dev/null; then
    echo "browser: skipped, there is no npm"
    exit 0
fi
rm -rf "$browser"
mkdir -p "$browser"
cp tests/browser/package.json "$browser/"
if ! (cd "$browser" && npm install --no-audit --no-fund --silent); then
    echo "browser: skipped, the packages could not be installed"
    exit 0
fi
touch "$browser/ready"
echo "browser: ready in $browser"
