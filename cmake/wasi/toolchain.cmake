# SPDX-License-Identifier: Apache-2.0
# WebAssembly by Debian 12's clang-19, wasi-libc and libc++-19-dev-wasm32.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_C_COMPILER clang-19)
set(CMAKE_CXX_COMPILER clang++-19)
set(CMAKE_AR llvm-ar-19)
set(CMAKE_RANLIB llvm-ranlib-19)
set(CMAKE_C_COMPILER_TARGET wasm32-wasi)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_EXECUTABLE_SUFFIX_C .wasm)
set(CMAKE_EXECUTABLE_SUFFIX_CXX .wasm)
set(CMAKE_INSTALL_LIBDIR lib CACHE PATH "")
# Debian's libc++ for WebAssembly has no exceptions: one that is thrown ends the instance, see exceptions.cpp.
set(CMAKE_CXX_FLAGS_INIT "-msimd128 -fno-rtti -fignore-exceptions -fvisibility=hidden -DEIGEN_NO_THREADS")
set(CMAKE_C_FLAGS_INIT "-msimd128")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-z,stack-size=1048576")
# There are no threads, nor a pthread.h to look for.
set(CMAKE_HAVE_PTHREAD_H TRUE CACHE INTERNAL "")
set(CMAKE_HAVE_LIBC_PTHREAD TRUE CACHE INTERNAL "")
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
