#!/usr/bin/env bash
# `pip wheel` of the checkout and its installation into a fresh virtual environment: pip_check.sh SOURCE WORK [BUILD].
# With Debian's packages, without the network. With a build tree BUILD the wheel gets what was built there, which saves
# the time of a second build. Exit code 77 (skipped) where Debian's packages are missing.
set -euo pipefail
source=$(readlink -f "$1")
work=$2
built=${3:+$(readlink -f "$3")}
if ! /usr/bin/python3 -W ignore -c 'import skbuild, setuptools, wheel, pip, venv, ensurepip, numpy' 2>/dev/null; then
  echo "skipped: needs python3-skbuild, python3-setuptools, python3-wheel, python3-pip, python3-venv and python3-numpy"
  exit 77
fi
rm -rf "$work"
mkdir -p "$work"
work=$(readlink -f "$work")
# A copy, because the build writes beside the sources.
(cd "$source" && { git ls-files -z --cached --others --exclude-standard 2>/dev/null || find . -path ./build -prune -o -type f -print0; } |
  xargs -0 sh -c 'for file; do [ ! -e "$file" ] || cp --parents "$file" "$0"; done' "$work")
cd "$work"
[ -z "$built" ] || export SKBUILD_CONFIGURE_OPTIONS="-DVANTAGE_BUILT=$built"
/usr/bin/python3 -m pip wheel --quiet --no-build-isolation --no-deps --wheel-dir wheels .
/usr/bin/python3 -m venv --system-site-packages fresh
fresh/bin/pip install --quiet --no-deps --no-index wheels/vantage-*.whl
cd /
"$work/fresh/bin/python" -c 'import vantage; print(vantage.__version__, vantage.__file__)' | grep -F "$work/fresh"
"$work/fresh/bin/vantage" --version
"$work/fresh/bin/vantage" objects | grep -q mug
# Without numpy the module says what to install.
/usr/bin/python3 -m venv "$work/bare"
"$work/bare/bin/pip" install --quiet --no-deps --no-index "$work"/wheels/vantage-*.whl
("$work/bare/bin/python" -c 'import vantage' 2>&1 || true) | grep -F "ImportError: vantage needs numpy: install Debian's python3-numpy"
"$work/fresh/bin/pip" uninstall --quiet --yes vantage
[ ! -e "$work/fresh/bin/vantage" ]
echo "wheel built, installed, used and removed"
