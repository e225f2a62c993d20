// SPDX-License-Identifier: Apache-2.0
/* SAC_API marks the functions of C, which are all that libsac.so exports. */
#ifndef SAC_EXPORT_H
#define SAC_EXPORT_H

#if defined(_WIN32) && defined(SAC_BUILDS_SHARED)
#define SAC_API __declspec(dllexport)
#elif defined(_WIN32) && defined(SAC_USES_SHARED)
#define SAC_API __declspec(dllimport)
#elif defined(__GNUC__) || defined(__clang__) /* ELF and Mach-O; Windows' static libraries do not care */
#define SAC_API __attribute__((visibility("default")))
#else
#define SAC_API
#endif

#endif
