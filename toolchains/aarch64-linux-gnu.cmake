# 64-bit ARM (Debian's arm64): Raspberry Pi 3 to 5 with a 64-bit system, Jetson boards.
set(EDGESLAM_TRIPLET aarch64-linux-gnu)
set(EDGESLAM_EMULATOR qemu-aarch64-static)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(EDGESLAM_SYSROOT ${CMAKE_CURRENT_LIST_DIR}/../build/sysroot-arm64 CACHE PATH "As toolchains/make-sysroot arm64 makes it")
include(${CMAKE_CURRENT_LIST_DIR}/debian-cross.cmake)
