// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stddef.h>

/// Declarations of what is used of the C library, which Debian has no package of for each of the boards.
extern "C" {
void* memcpy(void* to, const void* from, size_t count);
void* memmove(void* to, const void* from, size_t count);
void* memset(void* bytes, int byte, size_t count);
char* strncpy(char* to, const char* from, size_t count);
size_t strlen(const char* text);
int strcmp(const char* one, const char* other);
}
