#!/usr/bin/env bash
# Builds a worker that runs on systems with glibc 2.28 and newer (RHEL 8, Debian 10, Ubuntu 18.10), for
# --worker-program: cargo-zigbuild and ziglang from PyPI link it, into target/portable.
#
#     deploy/portable.sh [MACHINE]        x86_64 or aarch64; needs rustup's target for a foreign one
set -euo pipefail
cd "$(dirname "$0")/.."
machine=${1:-$(uname -m)}
newest=2.28
tools=target/portable/tools
if [[ ! -x "$tools/bin/cargo-zigbuild" ]]; then
  python3 -m venv "$tools"
  "$tools/bin/pip" install --quiet cargo-zigbuild==0.24.0 ziglang
fi
PATH="$PWD/$tools/bin:$PATH"
profile=${HORSEHEAD_PROFILE:-release}
target=$machine-unknown-linux-gnu
cargo zigbuild --profile "$profile" -p worker --target "$target.$newest"
# cargo calls the folder of its profile dev otherwise
folder=${profile/#dev/debug}
install -D "target/$target/$folder/horsehead-worker" "target/portable/$machine/horsehead-worker"
echo "made target/portable/$machine/horsehead-worker for glibc $newest and newer:"
echo "  --worker-program $machine=$PWD/target/portable/$machine/horsehead-worker"
