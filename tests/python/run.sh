#!/usr/bin/env bash
# Runs one file of tests with Debian's Python and the package in BUILD: run.sh BUILD SOURCES FILE
#
# Exit codes: 0 passed, 1 failed, 77 skipped: this machine has no /usr/bin/python3, or no numpy.
set -euo pipefail

build=$1 sources=$2 file=$3
python=/usr/bin/python3
[[ -x $python ]] || { echo "python: skipped: no $python here"; exit 77; }
"$python" -c 'import numpy' 2>/dev/null || { echo "python: skipped: no numpy here (docker/install.sh python-run)"; exit 77; }
cd "$sources/tests/python"
PYTHONPATH=$build/lib/python3/dist-packages PYTHONDONTWRITEBYTECODE=1 PLAB_SOURCES=$sources exec "$python" -W error::ResourceWarning -m unittest -v "$file"
