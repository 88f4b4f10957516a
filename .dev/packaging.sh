# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh disable=SC2016,SC2086,SC2153,SC2154,SC2164 # words split; set -e is ./dev's
#
# Read by ./dev: the files that are handed out. The core is compiled once for each target and the
# bindings for each CPython; the Python package in .dev/packaging/ makes the archives.

ZIG_REQUIREMENTS='ziglang==0.17.1'
ZIG=$(environment zig "$ZIG_REQUIREMENTS")
PACKAGE_BUILD=$ROOT/build/package
UNPACKED_WHEEL=$PACKAGE_BUILD/installed

# The targets, named as Blender names platforms; each has its file in .dev/packaging/toolchains.
TARGETS='linux-x64 windows-x64 macos-arm64'
THIS_TARGET=linux-x64
MACOS_PACKAGES='lld-19'

# pythons_of TARGET: the CPythons that a module is built for.
pythons_of() {
  case $1 in
    linux-x64) echo 3.11 3.13 3.14 ;;
    *) echo 3.11 3.13 ;; # Blender's own downloads; 3.14 is Debian's alone
  esac
}

verb_package() {
  case ${1:-} in
    '' | --quick) ;;
    *) usage >&2 && exit 2 ;;
  esac
  make_release_files "$@"
  cat "$(log_of 'Make the release files')"
  if [ $# -eq 0 ]; then test_release_files; fi
}

# The suites on the modules that were made; the report names those that ran on each module.
test_release_files() {
  basics $BLENDER_PACKAGES
  python313=$(find_python313)
  locked "$CACHE/lock" need_bpy
  use_environment
  suite 'Python' test_python_on_wheel
  test_blenders
  for version in 4.3 5.2; do
    if has_root "$version"; then
      need_blender "$version"
      suite "Blender $version" test_blender "$version"
    fi
  done
  echo "$passed passed, $failed failed"
  [ "$failed" -eq 0 ]
  note_tested_modules
}

# Adds the suites that ran to the report of the release files.
note_tested_modules() {
  printf %s "$passed_suites" | PYTHONPATH=$ROOT/.dev/packaging xargs -d '\n' \
    python -m release_files.tested "$ROOT/build/packages/report.json"
}

test_python_on_wheel() {
  export PYTHONPATH="$UNPACKED_WHEEL" SPARSE_MOCAP_TEST_PATH="$UNPACKED_WHEEL"
  test_python
}

# unpack_wheel TAG: what pip would install from the wheel for that CPython, and the demo.
unpack_wheel() {
  rm -rf "$UNPACKED_WHEEL"
  mkdir -p "$UNPACKED_WHEEL"
  "$VENV/bin/python" -m zipfile -e "$ROOT"/build/packages/*-"$1-$1"-manylinux*.whl \
    "$UNPACKED_WHEEL"
  ln -s "$ROOT/bindings/sparse_mocap_demo" "$UNPACKED_WHEEL/"
}

# make_release_files [--quick]: in build/packages, checked; with --quick for this machine alone.
make_release_files() {
  case ${1:-} in
    --quick) targets=$THIS_TARGET && basics ;;
    *) targets=$TARGETS && basics $MACOS_PACKAGES $WINDOWS_PACKAGES ;;
  esac
  locked "$CACHE/lock" need_zig
  locked "$CACHE/lock" need_headers
  case $targets in *windows*) locked "$CACHE/lock" need_windows_pythons ;; esac
  locked "$ROOT/build/lock" build_and_pack $targets
}

build_and_pack() {
  step 'Gather headers' gather_headers "$@"
  for target in "$@"; do
    locked "$(ceres_of "$target").lock" need_ceres "$target"
    step "Build for $target" for_target "$target" build_modules "$target"
  done
  step 'Make the release files' pack_release_files
  step 'Unpack the wheel for the tests' unpack_wheel cp311
}

pack_release_files() {
  env PYTHONPATH="$ROOT/.dev/packaging" PYTHONNOUSERSITE=1 "$VENV/bin/python" -m release_files "$ROOT" \
    --modules "$PACKAGE_BUILD/modules" --pyserial "$ZIG/pyserial" --headers "$PACKAGE_BUILD/python" \
    --output "$ROOT/build/packages"
}

# release_file_for VERSION: what that Blender, or module bpy, installs.
release_file_for() {
  for path in "$ROOT"/build/packages/*.zip; do
    case $1:$path in
      3.4:*-legacy-$THIS_TARGET.zip) echo "$path" ;;
      3.4:* | *-legacy-*) ;;
      *) echo "$path" ;;
    esac
  done
}

need_zig() {
  need_environment 'Install zig' "$ZIG" /usr/bin/python3 "$ZIG_REQUIREMENTS"
  [ -d "$ZIG/pyserial" ] || QUIET='' step 'Fetch the wheel of pyserial' fetch_pyserial
}

# PyPI's own file goes into the extension as it is, so its hash is pinned too.
fetch_pyserial() {
  rm -rf "$ZIG/pyserial.part"
  mkdir "$ZIG/pyserial.part"
  echo 'pyserial==3.5 --hash=sha256:c4451db6ba391ca6ca299fb3ec7bae67a5c55dde170964c7a14ceefec02f2cf0' \
    >"$ZIG/pyserial.txt"
  "$ZIG/bin/python" -m pip download --disable-pip-version-check --no-input --no-deps \
    --only-binary :all: --require-hashes -r "$ZIG/pyserial.txt" -d "$ZIG/pyserial.part"
  mv "$ZIG/pyserial.part" "$ZIG/pyserial"
}

# --- Headers -------------------------------------------------------------------------------------

# The headers of CPythons that later Debians have.
need_headers() {
  need_header_folder 3.13 trixie
  need_header_folder 3.14 forky
}

need_header_folder() {
  [ -d "$CACHE/headers-$1" ] ||
    QUIET='' step "Fetch the headers of CPython $1" fetch_headers "$1" "$2"
}

fetch_headers() {
  headers=$CACHE/headers-$1
  work=$(mktemp -d "$CACHE/headers.XXXXXX")
  trap 'rm -rf "$work"' EXIT
  package=libpython$1-dev
  apt_of "$work" deb "$2" download "$package"
  dpkg-deb -x "$package"_*.deb unpacked
  mv unpacked/usr/include "$headers"
}

# gather_headers TARGET...: what compilers for these may see: the libraries that are headers alone, and
# those of each CPython, copied so that the rest of /usr/include stays out of sight.
gather_headers() {
  prefix=$PACKAGE_BUILD/prefix
  rm -rf "$PACKAGE_BUILD"
  mkdir -p "$prefix/include"
  cp -RLp /usr/include/eigen3/. /usr/include/nlohmann /usr/include/nanoflann.hpp \
    /usr/include/xxhash.h "$prefix/include/"
  write_cmake_package "$prefix" Eigen3 Eigen3::Eigen libeigen3-dev
  write_cmake_package "$prefix" nanoflann nanoflann::nanoflann libnanoflann-dev
  write_cmake_package "$prefix" nlohmann_json nlohmann_json::nlohmann_json nlohmann-json3-dev
  for target in "$@"; do
    for version in $(pythons_of "$target"); do
      gather_python_headers "$target" "$version"
    done
  done
}

# python_headers TARGET VERSION: the folder for that CPython's headers.
python_headers() { echo "$PACKAGE_BUILD/python/$1-$2"; }

# gather_python_headers TARGET VERSION: pyconfig.h describes the system; that of 64-bit Linux is true
# of macOS in all that modules see, but for the names of BSD that macOS has as well.
gather_python_headers() {
  folder=$(python_headers "$1" "$2")
  mkdir -p "$folder"
  case $1:$2 in
    windows-*) cp -Rp "$(windows_headers "$2")/." "$folder" && return ;;
    *:3.11) from=/usr/include ;; # this Debian's own
    *) from=$CACHE/headers-$2 ;;
  esac
  cp -RLp "$from/python$2/." "$folder"
  cp -Lp "$from/x86_64-linux-gnu/python$2/pyconfig.h" "$folder"
  case $1 in
    macos-*)
      echo '#define _DARWIN_C_SOURCE 1' >>"$folder/pyconfig.h"
      touch -r "$folder/Python.h" "$folder/pyconfig.h" # it is as old as before
      ;;
  esac
}

# write_cmake_package PREFIX NAME TARGET PACKAGE: CMake's own package of a library names /usr/include;
# this one names the folder. The version is that of the Debian package.
write_cmake_package() {
  folder=$1/share/cmake/$2
  mkdir -p "$folder"
  version=$(dpkg-query -W -f '${Version}' "$4" | sed 's/[^0-9.].*//')
  cat >"$folder/$2Config.cmake" <<EOF
if(NOT TARGET $3)
  add_library($3 INTERFACE IMPORTED)
  set_target_properties($3 PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "$1/include")
endif()
EOF
  cat >"$folder/$2ConfigVersion.cmake" <<EOF
set(PACKAGE_VERSION "$version")
set(PACKAGE_VERSION_COMPATIBLE TRUE)
EOF
}

# --- Building ------------------------------------------------------------------------------------

# for_target TARGET COMMAND...: COMMAND and the options that tell CMake to compile for TARGET.
for_target() {
  toolchain=$ROOT/.dev/packaging/toolchains/$1.cmake
  # zig, as ccache sees it, is a script that never changes.
  [ "$1" = windows-x64 ] || export CCACHE_COMPILERCHECK="string:$ZIG_REQUIREMENTS"
  shift
  export SPARSE_MOCAP_ZIG="$ZIG/lib/python3.11/site-packages/ziglang/zig"
  export ZIG_GLOBAL_CACHE_DIR="$CACHE/zig-cache" ZIG_LOCAL_CACHE_DIR="$CACHE/zig-cache"
  "$@" -DCMAKE_TOOLCHAIN_FILE="$toolchain" -DSPARSE_MOCAP_PREFIX="$PACKAGE_BUILD/prefix"
}

# build_modules TARGET CMAKE_OPTION...: zig adds -g by itself: a quarter more work, and the names of
# folders, for what is dropped again.
build_modules() {
  target=$1
  shift
  wanted=''
  for version in $(pythons_of "$target"); do
    set -- "$@" -DSPARSE_MOCAP_HEADERS_$version="$(python_headers "$target" "$version")"
    wanted="$wanted _core_$version"
  done
  [ "$target" != windows-x64 ] || set -- "$@" $(windows_python_options)
  cd "$ROOT"
  cmake --fresh --preset package -B "build/package-$target" "$@" \
    -DSPARSE_MOCAP_XXHASH_INCLUDE_DIR="$PACKAGE_BUILD/prefix/include" \
    -DCMAKE_CXX_FLAGS="-g0 -ffile-prefix-map=$ROOT=. -ffile-prefix-map=$CACHE=." \
    -DCeres_DIR="$(ceres_of "$target")/lib/cmake/Ceres" \
    -DPython_EXECUTABLE="$VENV/bin/python" \
    -DPython_INCLUDE_DIR="$(python_headers "$target" 3.11)" \
    -Dpybind11_DIR="$("$VENV/bin/python" -m pybind11 --cmakedir)"
  cmake --build "build/package-$target" --target $wanted
}
