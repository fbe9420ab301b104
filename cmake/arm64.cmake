# SPDX-License-Identifier: Apache-2.0
# A build for 64-bit ARM (Jetson, Raspberry Pi) on another machine: Debian's g++-aarch64-linux-gnu,
# libraries of arm64 in a folder of their own, which scripts/arm64.sh fills, and qemu to run the
# tests. KELPIE_ARM64_CPU: the processor that qemu plays, by default that of a Raspberry Pi 4. `max`
# has SVE as well, which qemu is ten times slower with.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

set(KELPIE_ARM64_ROOT "${CMAKE_CURRENT_LIST_DIR}/../build/arm64-root" CACHE PATH
    "Libraries of arm64 and their headers")
set(KELPIE_ARM64_CPU "cortex-a72" CACHE STRING "The processor that qemu plays")
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES KELPIE_ARM64_ROOT KELPIE_ARM64_CPU)
get_filename_component(root "${KELPIE_ARM64_ROOT}" ABSOLUTE)
set(CMAKE_FIND_ROOT_PATH "${root}")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
# Where Debian's own compiler of arm64 would look by itself: headers of that machine, and the
# libraries that libraries need.
set(CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES "${root}/usr/include/aarch64-linux-gnu")
set(CMAKE_EXE_LINKER_FLAGS_INIT
    "-Wl,-rpath-link,${root}/usr/lib/aarch64-linux-gnu:${root}/lib/aarch64-linux-gnu")
set(ENV{PKG_CONFIG_LIBDIR} "${root}/usr/lib/aarch64-linux-gnu/pkgconfig:${root}/usr/share/pkgconfig")
set(ENV{PKG_CONFIG_SYSROOT_DIR} "${root}")

set(CMAKE_CROSSCOMPILING_EMULATOR
    qemu-aarch64 -cpu ${KELPIE_ARM64_CPU} -L /usr/aarch64-linux-gnu
    -E "LD_LIBRARY_PATH=${root}/usr/lib/aarch64-linux-gnu:${root}/lib/aarch64-linux-gnu")
