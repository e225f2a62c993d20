// SPDX-License-Identifier: Apache-2.0
/* The version of the library, for the preprocessor; sac_version() gives that of the library that is linked. */
#ifndef SAC_VERSION_H
#define SAC_VERSION_H

/* Semantic versions: before 1.0.0 a new SAC_VERSION_MINOR may change the interface, SAC_VERSION_PATCH does not. */
#define SAC_VERSION_MAJOR 0
#define SAC_VERSION_MINOR 2
#define SAC_VERSION_PATCH 0

/* One number that grows with each version, for #if: 2000000 is 2.0.0. */
#define SAC_VERSION_NUMBER (SAC_VERSION_MAJOR * 1000000 + SAC_VERSION_MINOR * 1000 + SAC_VERSION_PATCH)

/* The version of the streams that the encoder writes and the decoder reads (spec.md 4). */
#define SAC_STREAM_VERSION_MAJOR 0
#define SAC_STREAM_VERSION_MINOR 9

#define SAC_QUOTED_(x) #x
#define SAC_QUOTED(x) SAC_QUOTED_(x)
#define SAC_VERSION_STRING \
  SAC_QUOTED(SAC_VERSION_MAJOR) "." SAC_QUOTED(SAC_VERSION_MINOR) "." SAC_QUOTED(SAC_VERSION_PATCH)
#define SAC_STREAM_VERSION_STRING SAC_QUOTED(SAC_STREAM_VERSION_MAJOR) "." SAC_QUOTED(SAC_STREAM_VERSION_MINOR)

#endif
