/* SPDX-License-Identifier: Apache-2.0 */

/* A client and a service in one program of C only, for a checker of memory. With an argument both
 * speak format 2. */

#include <stdio.h>

#include "all_members.h"
#include "packing.h"

int main(int count, char** arguments) {
  rr_node* service = NULL;
  rr_node* client = NULL;
  all_members* offered = NULL;
  rr_node_options options = {0};
  uint16_t port = 0;
  const char* wrong = "nodes";
  (void)arguments;
  if (rr_abi_version() >> 16 != RR_ABI_VERSION >> 16) return 2;
  options.size = sizeof options;
  options.client_without = count > 1 ? RR_WITHOUT_V4 : 0;
  if (rr_node_new(NULL, &service, NULL) == RR_OK && rr_node_new(&options, &client, NULL) == RR_OK &&
      (offered = all_members_offer(service)) != NULL &&
      rr_node_listen(service, str("rr+tcp://127.0.0.1:0"), &port, NULL) == RR_OK) {
    wrong = all_members_use(client, port);
  }
  rr_node_release(client);
  rr_node_release(service);
  all_members_release(offered);
  if (wrong == NULL && all_members_contexts() != 0) wrong = "contexts are left";
  if (wrong != NULL) {
    fprintf(stderr, "failed: %s\n", wrong);
    return 1;
  }
  /* In wine a program that crashes ends with 0, too. */
  puts("all members: PASSED");
  return 0;
}
