/* SPDX-License-Identifier: Apache-2.0 */
#include "rr.h"

uint32_t rr_test_header_c(void);
uint32_t rr_test_header_c(void) { return RR_ABI_VERSION; }
