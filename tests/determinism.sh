#!/bin/sh
# Digests of the reference run, of its derivatives and of a head's reduction in several builds: optimisation levels of the
# dynamics and instruction sets. Every build must reproduce those in
# worker/simulation/tests/numerics/determinism.rs.
# Builds go to target/determinism and take some minutes the first time. Run from anywhere:
#   tests/determinism.sh
set -eu
cd "$(dirname "$0")/.."
export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-target}/determinism"
check() {
    level=$1 flags=$2 tests=${3:-}
    echo "optimisation $level, ${flags:-instruction set of the default target}"
    RUSTFLAGS="$flags" cargo test --quiet -p simulation \
        --config "profile.dev.package.simulation.opt-level=$level" \
        --test numerics "determinism::$tests"
}
check 3 ""
# a run is some sixty times slower there: threads and fused operations have been tried above
check 0 "" every_build_reproduces
case "$(uname -m)" in
x86_64)
    check 3 "-C target-cpu=x86-64-v2"
    # a processor without AVX2 cannot run this one
    if grep -q avx2 /proc/cpuinfo; then
        check 3 "-C target-cpu=x86-64-v3"
    fi
    ;;
esac
echo "all builds agree"
