#!/usr/bin/env bash
# Makes the Python environment against which some tests compare, under target/peers: numpy, scipy and pymavlink, at the
# versions of requirements.txt, RotorPy and MuJoCo without the plotting, learning and window packages that their dynamics
# do not use, MAVSDK, and readers of tables and MCAP. MuJoCo, MAVSDK and these are not to be had for every platform. Says so and succeeds where Python or the
# packages cannot be had: those tests then skip themselves.
set -euo pipefail
cd "$(dirname "$0")/../.."
peers="${CARGO_TARGET_DIR:-target}/peers"
requirements=tests/peers/requirements.txt
rotorpy=tests/peers/rotorpy.txt
mujoco=tests/peers/mujoco.txt
mavsdk=tests/peers/mavsdk.txt
tables=tests/peers/tables.txt

if [ -f "$peers/requirements.txt" ] && cat "$requirements" "$rotorpy" "$mujoco" "$mavsdk" "$tables" | cmp -s - "$peers/requirements.txt"; then
    echo "peers: ready in $peers"
    exit 0
fi
if ! command -v python3 >/dev/null; then
    echo "peers: skipped, there is no python3"
    exit 0
fi
if ! python3 -m venv --clear "$peers"; then
    echo "peers: skipped, python3 cannot make a virtual environment (on Debian: apt install python3-venv)"
    rm -rf "$peers"
    exit 0
fi
pip() {
    "$peers/bin/python" -m pip install --quiet --disable-pip-version-check "$@"
}
if ! pip --requirement "$requirements" || ! pip --no-deps --requirement "$rotorpy"; then
    echo "peers: skipped, the packages could not be installed"
    rm -rf "$peers"
    exit 0
fi
if ! pip --only-binary :all: --no-deps --requirement "$mujoco"; then
    echo "peers: without MuJoCo, which could not be installed"
fi
if ! pip --only-binary :all: --requirement "$mavsdk"; then
    echo "peers: without MAVSDK, which could not be installed"
fi
if ! pip --only-binary :all: --requirement "$tables"; then
    echo "peers: without DuckDB, Polars, pandas, PyArrow and mcap, which could not be installed"
fi
cat "$requirements" "$rotorpy" "$mujoco" "$mavsdk" "$tables" >"$peers/requirements.txt"
echo "peers: ready in $peers"
