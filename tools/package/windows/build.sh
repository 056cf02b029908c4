#!/bin/sh
# Makes fppg.exe and fppg-VERSION-windows-x64.zip for Windows on Debian 12:
#
#   tools/package/windows/build.sh [FOLDER]     default: build/windows
#
# Installs the packages that are missing (setup.sh windows). Libraries that Debian has no package of for
# Windows are compiled from its source packages; sources.sha256 says what their files must be. A
# second call compiles what changed.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
folder=${1-$root/build/windows}
mkdir -p "$folder/sources" "$folder/libraries"
folder=$(cd "$folder" && pwd)
libraries=$folder/libraries

# Sources of packages from where this system has its packages, in lists of their own.
fetch_sources() {
    cd "$folder/sources"
    sha256sum --check --status "$here/sources.sha256" 2>/dev/null && return 0
    apt=$folder/apt
    mkdir -p "$apt/sources" "$apt/lists/partial" "$apt/cache/archives/partial"
    for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.sources /etc/apt/sources.list.d/*.list; do
        [ -f "$list" ] || continue
        sed 's/^Types:.*/Types: deb-src/; s/^deb /deb-src /' "$list" >"$apt/sources/$(basename "$list")"
    done
    cat >"$apt/apt.conf" <<END
Dir::Etc::sourcelist "/dev/null";
Dir::Etc::sourceparts "$apt/sources";
Dir::State::lists "$apt/lists";
Dir::Cache "$apt/cache";
APT::Sandbox::User "";
END
    APT_CONFIG=$apt/apt.conf apt-get update
    APT_CONFIG=$apt/apt.conf apt-get source --download-only --tar-only embree tinyxml2 fmtlib libpng1.6
    sha256sum --check "$here/sources.sha256"
}

# compile NAME ARCHIVE OPTIONS...: a static library, installed among the libraries.
compile() {
    name=$1
    archive=$folder/sources/$2
    shift 2
    [ ! -f "$libraries/$name.done" ] || return 0
    rm -rf "${folder:?}/$name"
    mkdir -p "$folder/$name/source"
    tar -xf "$archive" -C "$folder/$name/source" --strip-components=1
    if [ "$name" = embree ]; then
        # It takes every Windows for Microsoft's compiler, and lists a resource file for it.
        sed -i '/^# Compiler$/,/^# ISA/ s/^IF (WIN32)$/IF (MSVC)/' "$folder/$name/source/CMakeLists.txt"
        sed -i '/embree\.rc/d' "$folder/$name/source/kernels/CMakeLists.txt"
        # What both sizes of AVX share is compiled with the smaller one, which this leaves out.
        # shellcheck disable=SC2016
        sed -i 's/^  IF (${ISA} EQUAL ${ISA_LOWEST_AVX})$/  IF (${ISA} EQUAL ${AVX2})/
            s/^  IF (${ISA} EQUAL ${AVX})$/  IF (${ISA} EQUAL ${AVX2})/' "$folder/$name/source/kernels/CMakeLists.txt"
        sed -i 's/SELECT_SYMBOL_INIT_AVX(features,/SELECT_SYMBOL_INIT_AVX_AVX2(features,/' \
            "$folder/$name/source/kernels/bvh/bvh4_factory.cpp" "$folder/$name/source/kernels/bvh/bvh8_factory.cpp"
        # Debian leaves the manual out.
        sed -i '/readme\.pdf/d' "$folder/$name/source/common/cmake/package.cmake"
        # Where GCC speaks to Linux' linker.
        sed -i 's/ -z [a-z]*//g; s/ -pie"/"/' "$folder/$name/source/common/cmake/gnu.cmake"
    fi
    cmake -G Ninja -S "$folder/$name/source" -B "$folder/$name/build" \
        -DCMAKE_TOOLCHAIN_FILE="$here/toolchain.cmake" -DFPPG_WINDOWS_LIBRARIES="$libraries" \
        -DCMAKE_INSTALL_PREFIX="$libraries" -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=OFF "$@"
    cmake --build "$folder/$name/build" --target install
    touch "$libraries/$name.done"
}

compile_libraries() {
    compile tinyxml2 tinyxml2_9.0.0+dfsg.orig.tar.xz -Dtinyxml2_BUILD_TESTING=OFF
    compile fmt fmtlib_9.1.0+ds1.orig.tar.gz -DFMT_TEST=OFF -DFMT_DOC=OFF
    compile png libpng1.6_1.6.39.orig.tar.gz -DPNG_SHARED=OFF -DPNG_TESTS=OFF \
        -DZLIB_LIBRARY=/usr/x86_64-w64-mingw32/lib/libz.a
    # The program has surfaces of its own ("user") and spheres.
    compile embree embree_3.13.5+dfsg.orig.tar.xz -DEMBREE_TASKING_SYSTEM=INTERNAL -DEMBREE_STATIC_LIB=ON \
        -DEMBREE_ISPC_SUPPORT=OFF -DEMBREE_TUTORIALS=OFF -DEMBREE_IGNORE_CMAKE_CXX_FLAGS=OFF \
        -DEMBREE_ISA_SSE2=ON -DEMBREE_ISA_SSE42=OFF -DEMBREE_ISA_AVX=OFF -DEMBREE_ISA_AVX2=ON \
        -DEMBREE_ISA_AVX512=OFF -DEMBREE_GEOMETRY_TRIANGLE=OFF -DEMBREE_GEOMETRY_QUAD=OFF \
        -DEMBREE_GEOMETRY_CURVE=OFF -DEMBREE_GEOMETRY_SUBDIVISION=OFF -DEMBREE_GEOMETRY_GRID=OFF \
        -DEMBREE_GEOMETRY_INSTANCE=OFF
    # These are headers alone, the same for all systems.
    mkdir -p "$libraries/include" "$libraries/share/cmake"
    cp -r /usr/include/CLI /usr/include/nlohmann "$libraries/include"
    cp -r /usr/share/cmake/CLI11 /usr/share/cmake/nlohmann_json "$libraries/share/cmake"
}

"$root/tools/setup.sh" windows
fetch_sources
compile_libraries
cmake -G Ninja -S "$root" -B "$folder/fppg" -DCMAKE_TOOLCHAIN_FILE="$here/toolchain.cmake" \
    -DFPPG_WINDOWS_LIBRARIES="$libraries" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG" -DFPPG_UNITY=ON -DBUILD_TESTING=OFF -DFPPG_STEP=OFF \
    -DZLIB_LIBRARY=/usr/x86_64-w64-mingw32/lib/libz.a \
    ${FPPG_CMAKE_OPTIONS:+"$FPPG_CMAKE_OPTIONS"}
cmake --build "$folder/fppg" --target fppg_cli

# The zip: the program, its templates and cases, and the licences of what is inside it.
version=$(sed -n 's/^project(fppg VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
name=fppg-$version-windows-x64
rm -rf "${folder:?}/$name" "$folder/$name.zip"
mkdir -p "$folder/$name/licences"
x86_64-w64-mingw32-strip -o "$folder/$name/fppg.exe" "$folder/fppg/fppg.exe"
cp -r "$root/LICENSE" "$root/README.md" "$root/CHANGELOG.md" "$root/SECURITY.md" "$root/xml-templates" "$root/cases" \
    "$folder/fppg/fppg.spdx.json" "$folder/$name"
find "$folder/$name/cases" -name '*_out' -prune -exec rm -rf {} +
cp "$folder/embree/source/LICENSE.txt" "$folder/$name/licences/embree.txt"
cp "$folder/tinyxml2/source/LICENSE.txt" "$folder/$name/licences/tinyxml2.txt"
cp "$folder/fmt/source/LICENSE.rst" "$folder/$name/licences/fmt.txt"
cp "$folder/png/source/LICENSE" "$folder/$name/licences/libpng.txt"
for package in libz-mingw-w64-dev mingw-w64-x86-64-dev gcc-mingw-w64-base libcli11-dev nlohmann-json3-dev; do
    cp "/usr/share/doc/$package/copyright" "$folder/$name/licences/$package.txt"
done
(cd "$folder" && zip -qr "$name.zip" "$name")
ls -l "$folder/$name/fppg.exe" "$folder/$name.zip"
