# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh disable=SC2016,SC2086,SC2153,SC2154,SC2164 # words split; set -e is ./dev's
#
# Read by ./dev: the files that are handed out, for Linux x86-64 since glibc 2.28. zig compiles the
# core once and the bindings for each CPython; the Python package in .dev/packaging/ makes the archives.

ZIG_REQUIREMENTS='ziglang==0.17.1'
ZIG=$(environment zig "$ZIG_REQUIREMENTS")
PACKAGE_BUILD=$ROOT/build/package

verb_package() {
  case ${1:-} in
    '' | --quick) make_release_files "$@" ;;
    *) usage >&2 && exit 2 ;;
  esac
  cat "$(log_of 'Make the release files')"
}

# make_release_files [--quick]: in build/packages, checked.
make_release_files() {
  basics
  locked "$CACHE/lock" need_zig
  [ "${1:-}" = --quick ] || locked "$CACHE/lock" need_headers
  locked "$ROOT/build/lock" step 'Build (package)' build_package
  locked "$ROOT/build/lock" step 'Make the release files' pack_release_files
}

pack_release_files() {
  env PYTHONPATH="$ROOT/.dev/packaging" PYTHONNOUSERSITE=1 "$VENV/bin/python" -m release_files "$ROOT" \
    --modules "$PACKAGE_BUILD/modules" --pyserial "$ZIG/pyserial" --output "$ROOT/build/packages"
}

# release_file_for VERSION: what that Blender, or module bpy, installs.
release_file_for() {
  for path in "$ROOT"/build/packages/*.zip; do
    case $1:$path in
      3.4:*-legacy-*) echo "$path" ;;
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

need_headers() {
  need_header_folder 3.13 trixie
  need_header_folder 3.14 forky
}

# need_header_folder VERSION SUITE: the headers of a CPython that a later Debian has.
need_header_folder() {
  [ -d "$CACHE/headers-$1" ] ||
    QUIET='' step "Fetch the headers of CPython $1" fetch_headers "$1" "$2"
}

# By apt with lists of its own, as the source of Ceres is fetched.
fetch_headers() {
  headers=$CACHE/headers-$1
  work=$(mktemp -d "$CACHE/headers.XXXXXX")
  trap 'rm -rf "$work"' EXIT
  mkdir -p "$work/lists/partial" "$work/archives/partial"
  site=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Origin: Debian' \
    'Codename: bookworm' 'Component: main' | head -n 1)
  echo "deb ${site:-http://deb.debian.org/debian} $2 main" >"$work/sources.list"
  cd "$work"
  package=libpython$1-dev
  set -- -o Dir::Etc::SourceList="$work/sources.list" -o Dir::Etc::SourceParts=/dev/null \
    -o Dir::State::Lists="$work/lists" -o Dir::Cache="$work" -o Acquire::Retries=3 \
    -o APT::Sandbox::User="$(id -un)"
  apt-get "$@" update
  apt-get "$@" download "$package"
  dpkg-deb -x "$package"_*.deb unpacked
  mv unpacked/usr/include "$headers"
}

# header_folders VERSION: the folders with the headers of that CPython, as CMake lists them; nothing
# if there are none.
header_folders() {
  if [ -d "$CACHE/headers-$1" ]; then
    echo "$CACHE/headers-$1/python$1;$CACHE/headers-$1"
  elif [ "$1" = 3.13 ]; then
    python313=$(find_python313)
    [ -z "$python313" ] ||
      "$python313" -c 'import sysconfig; print(sysconfig.get_path("include"))'
  fi
}

# --- Building ------------------------------------------------------------------------------------

build_package() {
  export SPARSE_MOCAP_ZIG="$ZIG/lib/python3.11/site-packages/ziglang/zig"
  export ZIG_GLOBAL_CACHE_DIR="$CACHE/zig-cache" ZIG_LOCAL_CACHE_DIR="$CACHE/zig-cache"
  # The compiler that ccache sees is a script that never changes.
  export CCACHE_COMPILERCHECK="string:$ZIG_REQUIREMENTS"
  make_prefix "$PACKAGE_BUILD/prefix"
  # zig adds -g by itself: a quarter more work, and the names of folders, for what -s drops again.
  set -- -DSPARSE_MOCAP_PREFIX="$PACKAGE_BUILD/prefix" \
    -DSPARSE_MOCAP_XXHASH_INCLUDE_DIR="$PACKAGE_BUILD/prefix/include" \
    -DCMAKE_CXX_FLAGS="-g0 -ffile-prefix-map=$ROOT=. -ffile-prefix-map=$CACHE=." \
    -DPython_EXECUTABLE="$VENV/bin/python" \
    -DPython_INCLUDE_DIR="$PACKAGE_BUILD/prefix/include/python3.11" \
    -Dpybind11_DIR="$("$VENV/bin/python" -m pybind11 --cmakedir)"
  targets=_core # for this Debian's CPython, 3.11
  for version in 3.13 3.14; do
    folders=$(header_folders "$version")
    set -- "$@" -DSPARSE_MOCAP_HEADERS_$version="$folders"
    [ -z "$folders" ] || targets="$targets _core_$version"
  done
  rm -rf "$PACKAGE_BUILD/modules"
  cd "$ROOT"
  cmake --fresh --preset package "$@"
  cmake --build build/package --target $targets
}

# make_prefix FOLDER: the libraries that are headers alone, and the headers of this Debian's CPython,
# copied together so that the rest of /usr/include stays out of sight. CMake's packages of these name
# /usr/include itself; here each has one that names the folder.
make_prefix() {
  rm -rf "$1"
  mkdir -p "$1/include/x86_64-linux-gnu"
  cp -RLp /usr/include/eigen3/. /usr/include/nlohmann /usr/include/nanoflann.hpp \
    /usr/include/xxhash.h /usr/include/python3.11 "$1/include/"
  cp -RLp /usr/include/x86_64-linux-gnu/python3.11 "$1/include/x86_64-linux-gnu/"
  write_cmake_package "$1" Eigen3 Eigen3::Eigen libeigen3-dev
  write_cmake_package "$1" nanoflann nanoflann::nanoflann libnanoflann-dev
  write_cmake_package "$1" nlohmann_json nlohmann_json::nlohmann_json nlohmann-json3-dev
}

# write_cmake_package PREFIX NAME TARGET PACKAGE: the version is that of the Debian package.
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
