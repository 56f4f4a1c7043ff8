#!/usr/bin/env bash
# Builds and installs rvelab where conda-build says: SRC_DIR the source, PREFIX the environment, SP_DIR its Python modules.
set -euo pipefail
cd "${SRC_DIR:?is not set; conda-build sets it}"
cmake --preset release -D BUILD_TESTING=OFF -D CMAKE_PREFIX_PATH="${PREFIX:?}" -D CMAKE_INSTALL_PREFIX="$PREFIX" \
  -D CMAKE_INSTALL_LIBDIR=lib ${CMAKE_ARGS:-}
cmake --build --preset release --parallel "${CPU_COUNT:-2}"
for component in library umat program python; do
  cmake --install build/release --component "$component" --strip
done
mkdir -p "${SP_DIR:?}"
mv "$PREFIX"/lib/python3/dist-packages/* "$SP_DIR/"
rmdir "$PREFIX/lib/python3/dist-packages" "$PREFIX/lib/python3"
