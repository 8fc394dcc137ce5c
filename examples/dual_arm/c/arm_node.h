/* SPDX-License-Identifier: Apache-2.0
 *
 * A real-time node in plain C: what examples/dual_arm/cpp/arm_node.hpp is in C++. No heap, no lock; of
 * the kernel a step needs to receive and to send. */
#ifndef DUAL_ARM_ARM_NODE_H
#define DUAL_ARM_ARM_NODE_H

#include <netinet/in.h>

#include "experimental_dual_arm_bus.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  int socket;
  struct sockaddr_in peer;
  rr_bus_frame received;
  rr_bus_order order;
  rr_bus_frame sent;
  experimental_dual_arm_NodeCommand command;
  int64_t arrival; /* of the command, in nanoseconds; has_command says whether there is one */
  uint8_t has_command;
  double target[6];
  uint64_t next_sample;
  experimental_dual_arm_NodeState state;
} arm_node;

/* Listens at a free port of this machine, which it tells. 0, or -1 with errno. */
int arm_node_open(arm_node* node, uint16_t* port);
/* Sends its state there. */
void arm_node_connect(arm_node* node, uint16_t port);
/* One cycle of a millisecond; `now` in nanoseconds of any clock that goes on. */
void arm_node_step(arm_node* node, uint64_t sample, int64_t now);
void arm_node_close(arm_node* node);

#ifdef __cplusplus
}
#endif

#endif
