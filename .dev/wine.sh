# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh disable=SC2046,SC2086,SC2153,SC2154 # words split; ROOT and others are ./dev's
#
# Read by ./dev: tests of the release files for Windows, under Wine, with the CPython of python.org
# and the bpy of PyPI.

# NumPy 2.2 and later need a function that Wine 8 lacks, ucrtbase.crealf.
WINDOWS_PACKAGES_FOR_TESTS='bvhio==1.5.4 click==8.5.1 colorama==0.4.6 matplotlib==3.9.2 pybvh==0.9.0
  pyparsing==3.2.5 pyserial==3.5 pytest==9.2.0 rich==15.0.0 scipy==1.14.1 tzdata xxhash==4.1.0'
WINDOWS_BPY='bpy==4.5.15 numpy==1.26.4'
WINE_BUILD=$ROOT/build/windows
export SPARSE_MOCAP_WINE_DEVICES="$WINE_BUILD/wine/dosdevices"

# verb_windows [VERSION ARGS]: all tests, or that CPython with ARGS and the packed modules.
verb_windows() {
  QUIET=${1:+1}
  basics wine64
  locked "$CACHE/lock" need_windows_sites
  if [ $# -eq 0 ] || [ ! -d "$WINE_BUILD/3.11" ]; then
    make_release_files
    locked "$ROOT/build/lock" step 'Prepare Wine' prepare_wine
  fi
  if [ $# -eq 0 ]; then
    test_windows
  else
    in_windows_python "$@"
  fi
}

test_windows() {
  use_environment
  for version in $(pythons_of windows-x64); do
    suite "CPython $version for Windows" test_windows_python "$version"
  done
  suite 'bpy 4.5 for Windows' test_windows_bpy
  suite 'Windows beside Linux' test_windows_beside_linux
  echo "$passed passed, $failed failed, $skipped skipped"
  note_tested_modules
  [ "$failed" -eq 0 ]
}

# test_windows_python VERSION: the tests of the package and of the add-on's part without Blender.
test_windows_python() {
  cd "$ROOT"
  ALONE=1 in_windows_python "$1" -m pytest -q -p no:cacheprovider -c bindings/pyproject.toml \
    --rootdir . tests/python tests/blender/session
}

# test_windows_bpy: Blender's tests on the extension, installed by Blender. bpy may crash when Python
# ends, so what it printed counts.
test_windows_bpy() {
  cd "$ROOT"
  SPARSE_MOCAP_PACKAGE="Z:$(release_file_for 4.5)" \
    SPARSE_MOCAP_TEST_PYTHON="Z:$(windows_python 3.11)/python.exe" \
    SPARSE_MOCAP_TEST_PATH="$(windows_path 3.11)" \
    PYTHONPATH="$(windows_folders "$(windows_site 3.11 "$WINDOWS_BPY")" "$ROOT/tests/windows/wine")" \
    in_wine "$(windows_python 3.11)/python.exe" tests/blender/run.py || :
}

# test_windows_beside_linux: on this side too with what was packed.
test_windows_beside_linux() {
  PYTHONPATH="$UNPACKED_WHEEL" python -m pytest -q -rA -p no:cacheprovider \
    -c "$ROOT/bindings/pyproject.toml" --rootdir "$ROOT" "$ROOT/tests/windows"
}

# --- Packages ------------------------------------------------------------------------------------

windows_packages() {
  case $1 in
    3.11) echo "numpy==1.26.4 $WINDOWS_PACKAGES_FOR_TESTS" ;;
    3.13) echo "numpy==2.1.3 $WINDOWS_PACKAGES_FOR_TESTS" ;;
  esac
}

# windows_site VERSION REQUIREMENTS: the folder of those packages.
windows_site() { environment "windows-site-$1" "$2"; }

need_windows_sites() {
  for version in $(pythons_of windows-x64); do
    need_windows_site $version "$(windows_packages $version)"
  done
  need_windows_site 3.11 "$WINDOWS_BPY"
}

# need_windows_site VERSION REQUIREMENTS
need_windows_site() {
  [ -d "$(windows_site "$1" "$2")" ] ||
    QUIET='' step "Install packages for CPython $1 on Windows" make_windows_site "$1" "$2"
}

make_windows_site() {
  site=$(windows_site "$1" "$2")
  rm -rf "$site.part"
  "$VENV/bin/python" -m pip install --disable-pip-version-check --no-input --no-compile \
    --only-binary :all: --platform win_amd64 --implementation cp --python-version "$1" \
    --target "$site.part" $2
  mv "$site.part" "$site"
}

# --- Wine ----------------------------------------------------------------------------------------

# prepare_wine: a Windows of its own, and what the wheels of the release hold in folders.
prepare_wine() {
  rm -rf "$WINE_BUILD"
  mkdir -p "$WINE_BUILD"
  in_wine wineboot --init
  in_wine winecfg -v win10
  for version in $(pythons_of windows-x64); do
    tag=cp$(digits_of $version)
    unzip -q "$ROOT"/build/packages/*-$tag-$tag-win_amd64.whl -d "$WINE_BUILD/$version"
    cp -R "$ROOT/bindings/sparse_mocap_demo" "$WINE_BUILD/$version"
  done
}

# in_windows_python VERSION ARG...: with the packed modules and what the tests need.
in_windows_python() {
  windows_version=$1
  shift
  windows_python=Z:$(windows_python "$windows_version")/python.exe
  SPARSE_MOCAP_TEST_PYTHON=$windows_python \
    SPARSE_MOCAP_TEST_PATH=$(windows_path "$windows_version") \
    PYTHONPATH=$(windows_path "$windows_version") \
    in_wine "$(windows_python "$windows_version")/python.exe" -X faulthandler "$@"
}

windows_path() {
  windows_folders "$WINE_BUILD/$1" "$(windows_site "$1" "$(windows_packages "$1")")" \
    "$ROOT/tests/windows/wine"
}

# windows_folders FOLDER...: as PYTHONPATH lists them there; Z: is the root of this machine.
windows_folders() { printf 'Z:%s;' "$@"; }

# in_wine PROGRAM [ARG...]: the exit code is the program's. CPython there wants pipes at both ends, and
# ends lines as Windows does. With ALONE set, programs that it left running end with it: a test that
# failed may leave one, which would hold the pipe for ever.
in_wine() {
  wine_status=$(mktemp)
  : | {
    set +e
    env -u DISPLAY WINEPREFIX="$WINE_BUILD/wine" WINEARCH=win64 WINEDEBUG=-all LC_ALL=C.UTF-8 \
      WINEDLLOVERRIDES='mscoree,mshtml=' PYTHONNOUSERSITE=1 PYTHONDONTWRITEBYTECODE=1 \
      PYTHONUNBUFFERED=1 \
      /usr/lib/wine/wine64 "$@" 2>&1
    echo $? >"$wine_status"
    [ -z "${ALONE:-}" ] || WINEPREFIX="$WINE_BUILD/wine" /usr/lib/wine/wineserver64 -k
  } | sed -u 's/\r$//'
  wine_code=$(cat "$wine_status")
  rm -f "$wine_status"
  return "$wine_code"
}
