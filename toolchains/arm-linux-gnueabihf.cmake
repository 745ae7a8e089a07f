# 32-bit ARM with hardware floating point (Debian's armhf): Raspberry Pi 2 and later with a 32-bit system. NEON, which Debian's
# armhf does not promise, is there on all of them.
set(EDGESLAM_TRIPLET arm-linux-gnueabihf)
set(EDGESLAM_EMULATOR qemu-arm-static)
set(CMAKE_SYSTEM_PROCESSOR armv7l)
set(EDGESLAM_SYSROOT ${CMAKE_CURRENT_LIST_DIR}/../build/sysroot-armhf CACHE PATH "As toolchains/make-sysroot armhf makes it")
set(CMAKE_CXX_FLAGS_INIT "-mfpu=neon -Wno-psabi")
include(${CMAKE_CURRENT_LIST_DIR}/debian-cross.cmake)
