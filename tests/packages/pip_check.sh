#!/usr/bin/env bash
# `pip wheel` of the checkout and its installation into a fresh virtual environment: pip_check.sh SOURCE WORK. With
# Debian's packages, without the network. Exit code 77 (skipped) where they are missing.
set -euo pipefail
source=$(readlink -f "$1")
work=$2
if ! /usr/bin/python3 -c 'import skbuild, setuptools, wheel, pip, venv' 2>/dev/null; then
  echo "skipped: needs python3-skbuild, python3-setuptools, python3-wheel, python3-pip and python3-venv"
  exit 77
fi
rm -rf "$work"
mkdir -p "$work"
# A copy, because the build writes beside the sources.
git -C "$source" ls-files -z | (cd "$source" && xargs -0 cp --parents -t "$work" 2>/dev/null) || true
cd "$work"
/usr/bin/python3 -m pip wheel --quiet --no-build-isolation --no-deps --wheel-dir wheels .
/usr/bin/python3 -m venv --system-site-packages fresh
fresh/bin/pip install --quiet --no-deps --no-index wheels/vantage-*.whl
cd /
"$work/fresh/bin/python" -c 'import vantage; print(vantage.__version__, vantage.__file__)' | grep -F "$work/fresh"
"$work/fresh/bin/vantage" --version
"$work/fresh/bin/vantage" objects | grep -q mug
echo "wheel built, installed and used"
