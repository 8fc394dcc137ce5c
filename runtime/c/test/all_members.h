/* SPDX-License-Identifier: Apache-2.0 */
#ifndef RR_TEST_ALL_MEMBERS_H
#define RR_TEST_ALL_MEMBERS_H

/* Five services that have members of all kinds, as those of runtime/cpp/src/node/testing, and a
 * client that uses each of them. */

#include "rr.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct all_members all_members;
/* Registers `counter`, `board`, `pipes`, `wired` and `store`. NULL when something has failed. */
all_members* all_members_offer(rr_node* node);
/* Lets go of what the program holds; the services stay with their node. */
void all_members_release(all_members* offered);
/* How many contexts are still held by the runtime. */
int all_members_contexts(void);

/* Uses them. NULL when all is as it should be, else what is not. */
const char* all_members_use(rr_node* node, uint16_t port);

#ifdef __cplusplus
}
#endif

#endif
