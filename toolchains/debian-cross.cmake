# What the boards have in common: Debian's cross compiler, a sysroot of Debian packages, and QEMU to run tests.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_C_COMPILER ${EDGESLAM_TRIPLET}-gcc)
set(CMAKE_CXX_COMPILER ${EDGESLAM_TRIPLET}-g++)
set(CMAKE_LIBRARY_ARCHITECTURE ${EDGESLAM_TRIPLET})
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES EDGESLAM_SYSROOT)
get_filename_component(CMAKE_SYSROOT ${EDGESLAM_SYSROOT} ABSOLUTE)
if(NOT EXISTS ${CMAKE_SYSROOT}/usr/include)
  message(FATAL_ERROR "no sysroot in ${CMAKE_SYSROOT}: make it with toolchains/make-sysroot, or set EDGESLAM_SYSROOT")
endif()

# Programs of this machine, all else of the board's.
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${CMAKE_SYSROOT})
set(ENV{PKG_CONFIG_LIBDIR} ${CMAKE_SYSROOT}/usr/lib/${EDGESLAM_TRIPLET}/pkgconfig:${CMAKE_SYSROOT}/usr/share/pkgconfig)

# Libraries of libraries (BLAS below LAPACK) are found in the sysroot, too.
set(link_folders "-Wl,-rpath-link,${CMAKE_SYSROOT}/usr/lib/${EDGESLAM_TRIPLET}")
string(APPEND link_folders " -Wl,-rpath-link,${CMAKE_SYSROOT}/usr/lib/${EDGESLAM_TRIPLET}/blas")
string(APPEND link_folders " -Wl,-rpath-link,${CMAKE_SYSROOT}/usr/lib/${EDGESLAM_TRIPLET}/lapack")
set(CMAKE_EXE_LINKER_FLAGS_INIT "${link_folders}")
set(CMAKE_SHARED_LINKER_FLAGS_INIT "${link_folders}")
set(CMAKE_MODULE_LINKER_FLAGS_INIT "${link_folders}")

find_program(EDGESLAM_EMULATOR_PROGRAM ${EDGESLAM_EMULATOR})
if(EDGESLAM_EMULATOR_PROGRAM)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${EDGESLAM_EMULATOR_PROGRAM} -L ${CMAKE_SYSROOT})
endif()
