# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh disable=SC2086,SC2153,SC2154,SC2164 # words split; set -e and variables are ./dev's
#
# Read by ./dev: the release files on other Linuxes than this one, each a root of its own. Debian 11
# (glibc 2.31) runs CPython 3.11, built there from Debian's own source; Debian 13 runs bpy 5.2.

OLD_ROOT=$CACHE/root-debian11-1 # the last number counts the changes to make_old_root
BPY52_IN_ROOT=$(environment bpy52-debian13 "$BPY52_REQUIREMENTS")

verb_linux() {
  basics debootstrap
  make_release_files --quick
  use_environment
  need_old_linux
  suite 'Python on Debian 11' test_python_in_root
  need_bpy52_in_root
  suite 'bpy 5.2 on Debian 13' test_bpy_in_root
  echo "$passed passed, $failed failed"
  [ "$failed" -eq 0 ]
}

# --- Debian 11 -----------------------------------------------------------------------------------

need_old_linux() {
  root=$OLD_ROOT
  [ -d "$root" ] || locked "$root.lock" step 'Build CPython 3.11 in a root of Debian 11' make_old_root
}

make_old_root() {
  work=$(mktemp -d "$CACHE/python.XXXXXX")
  trap 'rm -rf "$work"' EXIT
  make_root "$OLD_ROOT.new" bullseye build-essential zlib1g-dev libffi-dev
  (apt_of "$work" deb-src bookworm --download-only source python3.11)
  mkdir "$work/python"
  tar xf "$work"/python3.11_*.orig.tar.* -C "$work/python" --strip-components 1
  root=$OLD_ROOT.new
  in_root sh -c 'cd "$0" && ./configure && make -j "$(nproc)" && make install' "$work/python"
  as_root mv "$OLD_ROOT.new" "$OLD_ROOT"
}

# The packages that the tests need are this machine's: both run CPython 3.11. Left out is what tests
# the sources and not the module: a method that is built for its test, the release files' own checks,
# and the README, whose commands run without PYTHONPATH.
test_python_in_root() {
  tests=$ROOT/tests/python
  in_root env PYTHONPATH="$UNPACKED_WHEEL:$VENV/lib/python3.11/site-packages" \
    PYTHONDONTWRITEBYTECODE=1 PATH=/usr/local/bin:/usr/bin:/bin \
    python3.11 -m pytest -q -p no:cacheprovider -c "$ROOT/bindings/pyproject.toml" --rootdir "$ROOT" \
    --numprocesses "$PROCESSORS" --dist loadfile --max-worker-restart 0 "$tests" \
    --ignore "$tests/test_fourth_method.py" --ignore "$tests/test_packaged_modules.py" \
    --ignore "$tests/test_readme.py"
}

# --- Debian 13 -----------------------------------------------------------------------------------

need_bpy52_in_root() {
  need_blender 4.3 # its root is of Debian 13
  [ -d "$BPY52_IN_ROOT" ] ||
    locked "$BPY52_IN_ROOT.lock" step 'Install bpy 5.2 for Debian 13' install_bpy52_for_root
}

# By this machine's pip, into an environment that runs in the root alone.
install_bpy52_for_root() {
  rm -rf "$BPY52_IN_ROOT.part"
  apt_install in_root libsm6 # bpy links it and Debian's Blender does not
  in_root python3.13 -m venv --without-pip "$BPY52_IN_ROOT.part"
  "$VENV/bin/python" -m pip install --disable-pip-version-check --no-input --only-binary :all: \
    --python-version 3.13 --platform manylinux_2_28_x86_64 --platform manylinux_2_17_x86_64 \
    --platform manylinux2014_x86_64 --ignore-requires-python \
    --target "$BPY52_IN_ROOT.part/lib/python3.13/site-packages" $BPY52_REQUIREMENTS
  mv "$BPY52_IN_ROOT.part" "$BPY52_IN_ROOT"
}

test_bpy_in_root() {
  in_root timeout 900 env SPARSE_MOCAP_PACKAGE="$(release_file_for 5.2)" \
    "$BPY52_IN_ROOT/bin/python" "$ROOT/tests/blender/run.py"
}
