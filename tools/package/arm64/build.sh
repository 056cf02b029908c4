#!/bin/sh
# Makes the program and its Debian packages for arm64 on Debian 12 of another processor:
#
#   tools/package/arm64/build.sh [FOLDER]     default: build/arm64
#
# Installs the packages that are missing (setup.sh arm64). The libraries of arm64 are unpacked into FOLDER/root,
# from the packages of this system's sources: nothing else of the system changes. With qemu-user,
# `qemu-aarch64 -L FOLDER/root FOLDER/fppg/fppg` runs the program.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../../.." && pwd)
folder=${1-$top/build/arm64}
mkdir -p "$folder/packages" "$folder/root"
folder=$(cd "$folder" && pwd)
root=$folder/root

# What the program is linked with, and what that needs to run under qemu.
unpack_libraries() {
    [ ! "$folder/unpacked" -nt "$here/packages.txt" ] || return 0
    apt=$folder/apt
    mkdir -p "$apt/lists/partial" "$apt/cache/archives/partial"
    cat >"$apt/apt.conf" <<END
APT::Architectures { "$(dpkg --print-architecture)"; "arm64"; };
APT::Sandbox::User "";
Dir::State::lists "$apt/lists";
Dir::Cache "$apt/cache";
END
    APT_CONFIG=$apt/apt.conf apt-get update
    cd "$folder/packages"
    # shellcheck disable=SC2046
    APT_CONFIG=$apt/apt.conf apt-get download $(sed 's/$/:arm64/' "$here/packages.txt")
    for package in *.deb; do dpkg-deb -x "$package" "$root"; done
    # Links from / on are meant from the root on: libz.so would lead out of it.
    find "$root" -type l -lname '/*' | while read -r link; do
        ln -sfrT "$root$(readlink "$link")" "$link"
    done
    # These are headers alone, the same for all systems.
    mkdir -p "$root/usr/include" "$root/usr/share/cmake"
    cp -r /usr/include/CLI /usr/include/nlohmann "$root/usr/include"
    cp -r /usr/share/cmake/CLI11 /usr/share/cmake/nlohmann_json "$root/usr/share/cmake"
    touch "$folder/unpacked"
}

"$top/tools/setup.sh" arm64
unpack_libraries
# dpkg-shlibdeps knows the libraries of packages that are installed, which these are not.
cmake -G Ninja -S "$top" -B "$folder/fppg" -DCMAKE_TOOLCHAIN_FILE="$here/toolchain.cmake" \
    -DFPPG_ARM64_ROOT="$root" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG" \
    -DFPPG_UNITY=ON -DBUILD_TESTING=OFF -DFPPG_STEP=OFF -DFPPG_SHLIBDEPS= \
    -DCMAKE_INSTALL_LIBDIR=lib/aarch64-linux-gnu \
    -DCPACK_DEBIAN_PACKAGE_ARCHITECTURE=arm64 -DCPACK_DEBIAN_FPPG_PACKAGE_DEPENDS="libc6 (>= 2.36), \
libembree3-3, libfmt9, libgcc-s1, libpng16-16, libstdc++6 (>= 12), libtinyxml2-9, zlib1g, libhdf5-103-1" \
    ${FPPG_CMAKE_OPTIONS:+"$FPPG_CMAKE_OPTIONS"}
cmake --build "$folder/fppg"
(cd "$folder/fppg" && cpack -G DEB)
