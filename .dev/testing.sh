# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh disable=SC2046,SC2086,SC2154 # lists of words split; ROOT and others are ./dev's
#
# Read by ./dev: the test suites, one line for each and what it printed if it fails.

passed=0 failed=0 skipped=0 left_out=0
passed_suites='' # a line each: NAME=LOG
PROCESSORS=$(nproc)

test_everything() {
  trap 'stop_background; exit 130' INT TERM
  suite 'C++' test_cpp
  suite 'Python' test_python
  test_blenders
  if [ "$left_out" -ne 0 ]; then
    echo "$left_out tests were skipped for lack of recorded data:" \
      'set SPARSE_MOCAP_DATA to its folder (see .github/CONTRIBUTING.md)'
  fi
  echo "$passed passed, $failed failed"
  [ "$failed" -eq 0 ]
}

# Why a test was skipped stands in ctest's own log alone.
test_cpp() {
  cpp_status=0
  ctest --test-dir "$ROOT/build/release" --output-on-failure --parallel "$PROCESSORS" ||
    cpp_status=$?
  grep -h '^SPARSE_MOCAP_DATA ' "$ROOT/build/release/Testing/Temporary/LastTest.log" || :
  return $cpp_status
}

# A test file stays in one process, so that its fixtures are made once.
test_python() {
  python -m pytest -q -p no:cacheprovider -c "$ROOT/bindings/pyproject.toml" --rootdir "$ROOT" \
    --numprocesses "$PROCESSORS" --dist loadfile --max-worker-restart 0 \
    "$ROOT/tests/python" "$ROOT/tests/blender/session"
}

# Blender's own suite waits for windows and sensors much of its time: the modules run meanwhile, one
# after the other.
test_blenders() {
  blender_suite="Blender $(PATH=$SYSTEM_PATH blender --version | awk 'NR == 1 { print $2 }')"
  user=$(mktemp -d)
  begin_suite "$blender_suite" in_blender "$(release_file_for 3.4)" \
    BLENDER_USER_RESOURCES="$user" BLENDER_USER_CONFIG="$user" BLENDER_USER_SCRIPTS="$user" \
    xvfb-run -a blender -b --factory-startup --python-exit-code 1 --python
  test_bpy
  end_suite "$blender_suite"
  rm -rf "$user"
}

test_bpy() {
  suite 'bpy 4.5' in_blender "$(release_file_for 4.5)" "$BPY45/bin/python"
  if [ -n "$python313" ]; then
    suite 'bpy 5.2' in_blender "$(release_file_for 5.2)" "$BPY52/bin/python"
  else
    echo 'bpy 5.2 ... left out: no CPython 3.13 here (PYTHON313 may name one)'
  fi
}

# in_blender PACKAGE [NAME=VALUE...] COMMAND...: COMMAND runs Blender's tests on what it installs
# from the release file, and sees nothing of the sources and their environment. For a shell of its
# own, which becomes COMMAND so that it can be stopped.
in_blender() {
  package=$1
  shift
  exec timeout 900 env -u PYTHONPATH -u PYTHONNOUSERSITE PATH="$SYSTEM_PATH" \
    SPARSE_MOCAP_PACKAGE="$package" SPARSE_MOCAP_TEST_PYTHON="$VENV/bin/python" \
    SPARSE_MOCAP_TEST_PATH="$UNPACKED_WHEEL" \
    "$@" "$ROOT/tests/blender/run.py"
}

# suite NAME COMMAND...: a test program and its line.
suite() {
  suite_name=$1
  shift
  suite_log=$(log_of "Test $suite_name")
  suite_start=$(date +%s)
  suite_status=0
  printf '%s ... ' "$suite_name"
  ("$@") >"$suite_log" 2>&1 </dev/null || suite_status=$?
  report_suite $(($(date +%s) - suite_start))
}

# begin_suite NAME COMMAND...: a test program in the background; one at a time.
begin_suite() {
  background_log=$(log_of "Test $1")
  background_start=$(date +%s)
  shift
  "$@" >"$background_log" 2>&1 </dev/null &
  background=$!
}

# end_suite NAME: waits for it; its line.
end_suite() {
  suite_name=$1
  suite_log=$background_log
  suite_status=0
  printf '%s ... ' "$suite_name"
  wait "$background" || suite_status=$?
  background=''
  report_suite $(($(stat -c %Y "$suite_log") - background_start)) # its last word was its last act
}

# Ctrl-C does not reach what runs in the background.
background=''
stop_background() { [ -z "$background" ] || kill "$background" 2>/dev/null || :; }

# report_suite SECONDS: the counts of $suite_log on a line, and the log itself if a test failed.
report_suite() {
  seconds=$1
  set -- $(counts "$suite_log")
  echo "$1 passed, $2 failed, $3 skipped, $seconds s"
  passed=$((passed + $1)) failed=$((failed + $2)) skipped=$((skipped + $3)) left_out=$((left_out + $4))
  passed_suites="$passed_suites$suite_name=$suite_log
"
  if [ "$suite_status" -ne 0 ] || [ "$1" -eq 0 ] || [ "$2" -ne 0 ]; then
    grep -vE ' Passed |^ +Start +[0-9]+: ' "$suite_log" || :
    echo "$suite_name ended with code $suite_status"
    [ "$2" -ne 0 ] || failed=$((failed + 1))
  fi
}

# counts LOG: "PASSED FAILED SKIPPED" from the closing line of ctest ("2 tests failed out of 9"), of
# pytest ("2 failed, 7 passed, 1 error in 3 s") or of tests/blender/run.py ("7 passed, 2 failed"),
# and how many were skipped for lack of recorded data.
counts() {
  awk '
    /^SKIPPED \[[0-9]+\].* SPARSE_MOCAP_DATA / { left_out += substr($2, 2) }
    /^(skipped: )?SPARSE_MOCAP_DATA / { left_out++ }
    /\*\*\*Skipped / { skipped++ }
    / tests? failed out of [0-9]+$/ { failed = $4; passed = $NF - $4 - skipped; next }
    /(^|[= ])[0-9]+ (passed|failed|errors?)(,|$| )/ {
      passed = failed = skipped = 0
      for (i = 2; i <= NF; i++) {
        if ($i ~ /^passed,?$/) passed = $(i - 1)
        if ($i ~ /^(failed|errors?),?$/) failed += $(i - 1)
        if ($i ~ /^skipped,?$/) skipped = $(i - 1)
      }
    }
    END { print passed + 0, failed + 0, skipped + 0, left_out + 0 }' "$1"
}
