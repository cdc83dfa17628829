#!/usr/bin/env bash
# tests/check_full.sh ROOT WORK: tests the plan, the memory and the table of ./check --full.
set -euo pipefail
export LC_ALL=C
root=$1 work=$2
rm -rf "$work"
mkdir -p "$work"
cd "$work"
fail() { echo "check_full: $*" >&2; exit 1; }

# All sources with one hash: what a plan needs to know of them.
(cd "$root" && find . \( -path ./build -o -path ./.git -o -path ./data \) -prune -o -type f -printf '1111111111  %P\n') >sources
"$root/scripts/check-plan" 1 <sources >whole
cut -d ' ' -f 4 whole | sort >stages
[ -z "$(uniq -d stages)" ] || fail "stages that are there twice: $(uniq -d stages)"

# Every test program is in the groups that run it.
for source in "$root"/tests/*_test.cpp; do
    program=$(basename "$source" .cpp)
    for group in release clang sanitize; do
        case $group/$program in sanitize/figures_test | sanitize/scans_test) continue ;; esac
        grep -qx "$group/$program" stages || fail "no stage $group/$program"
    done
done
for stage in tsan/batches_test tsan/wide_test long/matrix_test; do grep -qx $stage stages || fail "no stage $stage"; done

# Parts are disjoint, and together they are the whole. None takes a third longer than the mean.
for parts in 2 3 7; do
    "$root/scripts/check-plan" $parts <sources >plan
    cut -d ' ' -f 4 plan | sort | cmp - stages || fail "$parts parts are not the whole"
    awk -v parts=$parts '{ of[$1] += $2; all += $2 }
        END { for (p = 1; p <= parts; ++p) if (!(of[p] > 0 && of[p] < all / parts * 4 / 3)) exit 1
              for (p in of) if (p < 1 || p > parts) exit 1 }' plan || fail "$parts parts are uneven"
done

# changed PATTERN: the stages that run again when the files that match it change.
changed() {
    sed -E "s#^1+  ($1)\$#2222222222  \1#" sources >changed_sources
    ! cmp -s sources changed_sources || fail "no source matches $1"
    "$root/scripts/check-plan" 1 <changed_sources | comm -13 <(sort whole) <(sort -) | cut -d ' ' -f 4 | sort
}
[ "$(changed docs/api.md | grep -E "^(sanitize|tsan|long)/.*_test|^(tidy|build-dev|headers-alone)$" | paste -sd " ")" = \
    "long/doc_pictures_test sanitize/doc_pictures_test" ] ||
    fail "documents invalidate tests"
changed docs/api.md | grep -qx release/readme || fail "a document's blocks do not run again"
changed docs/api.md | grep -qx release/figures_test || fail "the tests of documents do not run again"
[ "$(changed tests/batches_test.cpp | grep _test | paste -sd ' ')" = \
    "clang/batches_test release/batches_test sanitize/batches_test tsan/batches_test" ] ||
    fail "a test's source invalidates other tests, or not its own"
changed include/hedgerow/geometry/vec.h | cmp - stages || fail "a header does not invalidate all"

# Memory and table, in a small copy that is a repository of its own and needs no packages.
mkdir copy
cp -r "$root"/{include,scripts,ARCHITECTURE.md} copy
mkdir copy/tests
cp "$root"/tests/{CMakeLists.txt,batches_test.cpp,figures_test.cpp,matrix_test.cpp} copy/tests
cd copy
: >packages.txt
echo build >.gitignore
git init -q
git add -A
git -c user.name=test -c user.email=test@localhost commit -qm "A copy"
known() {
    git ls-files -co --exclude-standard -z -- ':!scripts/check-seconds' | xargs -0 sha1sum | scripts/check-plan 2 |
        awk -v part="$1" '$1 == part { print "passed 3 abc1234 2026-01-01T00:00:00", $3, $4 }'
}
mkdir -p build/check-full
known 1 >build/check-full/records-1-of-2
! scripts/check-full --table >../table || fail "half of the stages are all"
grep -q '^format  *passed' ../table && grep -q '^tsan/\*_test  *left' ../table || fail "a table of one part: $(cat ../table)"
known 2 >build/check-full/records-2-of-2
scripts/check-full --table >../table || fail "parts together are not the whole: $(cat ../table)"
# The last outcome counts, whichever file has it.
tail -n 1 build/check-full/records-2-of-2 | sed 's/^passed/FAILED/; s/T00/T01/' >build/check-full/records-1-of-1
! scripts/check-full --table >../table || fail "a failure is not seen"
grep -q 'FAILED: tsan/batches_test' ../table || fail "a failure has no name: $(cat ../table)"
rm build/check-full/records-1-of-1
# What is left runs and is remembered.
sed -i '/ floors$/d' build/check-full/records-*
scripts/check-full --part 1/1 >../output || fail "a stage that should pass: $(cat ../output)"
[ "$(grep -c '^passed .* floors$' build/check-full/records-1-of-1)" = 1 ] || fail "it is not recorded: $(cat ../output)"
scripts/check-full >../output
grep -q ': 0 stages' ../output || fail "it runs again"
# So does what fails, until it passes.
echo '#include <hedgerow/index.h>' >>include/hedgerow/geometry/vec.h
sed -i '/ floors$/d' build/check-full/records-*
for part in 1 2; do known $part | grep -v ' floors$' >build/check-full/records-$part-of-2; done
! scripts/check-full >../output 2>&1 || fail "a fault passes"
grep -q '^floors  *FAILED' ../output || fail "a fault is not in the table: $(cat ../output)"
scripts/check-full >../output 2>&1 || true
grep -q ': 1 stages' ../output || fail "a fault is forgotten"

# Test programs: each test counts for its program, and programs that are not asked for do not run.
cat >CMakeLists.txt <<'EOF'
cmake_minimum_required(VERSION 3.25)
project(copy LANGUAGES NONE)
enable_testing()
foreach(program batches_test figures_test matrix_test)
  add_custom_target(${program} COMMAND ${CMAKE_COMMAND} -E copy ${CMAKE_SOURCE_DIR}/program ${CMAKE_BINARY_DIR}/${program})
  foreach(test one two)
    add_test(NAME ${program}.${test} COMMAND ${CMAKE_BINARY_DIR}/${program} "--gtest_filter=${test}")
  endforeach()
endforeach()
EOF
cat >program <<'EOF'
#!/bin/sh
echo "$0 $1" >>ran
case $0$1 in *figures_test*two) exit 1 ;; esac
EOF
chmod +x program
cat >CMakePresets.json <<'EOF'
{"version": 6,
 "configurePresets": [{"name": "release", "generator": "Ninja", "binaryDir": "${sourceDir}/build/release"}],
 "buildPresets": [{"name": "release", "configurePreset": "release"}],
 "testPresets": [{"name": "release", "configurePreset": "release"}]}
EOF
for part in 1 2; do known $part | grep -vE ' release/(batches|figures)_test$' >build/check-full/records-$part-of-2; done
rm build/check-full/records-1-of-1
! scripts/check-full >../output 2>&1 || fail "a failed test passes"
cut -d ' ' -f 1,6 build/check-full/records-1-of-1 | sort | paste -sd ' ' |
    grep -qx "FAILED release/figures_test passed release/batches_test" || fail "records: $(cat ../output)"
[ "$(sort build/release/ran | sed 's/.*\///' | paste -sd ' ')" = "$(printf '%s --gtest_filter=%s ' batches_test one batches_test two figures_test one figures_test two | sed 's/ $//')" ] || fail "other tests ran"

for wrong in "--part 0/2" "--part 3/2" "--part 1" --all; do
    rc=0
    scripts/check-full $wrong 2>/dev/null || rc=$?
    [ $rc = 2 ] || fail "$wrong is no wrong usage: $rc"
done
