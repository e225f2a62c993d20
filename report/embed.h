// SPDX-License-Identifier: Apache-2.0
#pragma once

// Embeds the bytes of a file in the program, from `symbol` to before `symbol`_end. C++20 has no #embed.
#define SAC_EMBED(symbol, path)                                                                         \
  __asm__(".section .rodata\n.global " #symbol "\n" #symbol ":\n.incbin \"" path "\"\n.global " #symbol \
          "_end\n" #symbol "_end:\n.byte 0\n.previous\n");                                              \
  extern "C" const char symbol[], symbol##_end[]
