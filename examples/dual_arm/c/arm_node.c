/* SPDX-License-Identifier: Apache-2.0 */
#include "examples/dual_arm/c/arm_node.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#define COMMAND_BYTES experimental_dual_arm_NodeCommand_FRAME_BYTES
#define STATE_BYTES experimental_dual_arm_NodeState_FRAME_BYTES

/* How long a command counts. */
static const int64_t lifespan = 5000000;

static struct sockaddr_in loopback(uint16_t port) {
  struct sockaddr_in address;
  memset(&address, 0, sizeof address);
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

int arm_node_open(arm_node* node, uint16_t* port) {
  struct sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  memset(node, 0, sizeof *node);
  node->sent.epoch = (uint64_t)time(NULL) * 1000000000u;
  node->socket = socket(AF_INET, SOCK_DGRAM, 0);
  if (node->socket < 0) return -1;
  if (bind(node->socket, (struct sockaddr*)&address, size) != 0 ||
      getsockname(node->socket, (struct sockaddr*)&address, &size) != 0) {
    arm_node_close(node);
    return -1;
  }
  *port = ntohs(address.sin_port);
  return 0;
}

void arm_node_connect(arm_node* node, uint16_t port) {
  /* Kept for sendto: a connected socket would hear from this peer only. */
  node->peer = loopback(port);
}

static void receive_commands(arm_node* node, int64_t now) {
  uint8_t bytes[COMMAND_BYTES + 1];
  int i;
  /* What waits, but not without an end. */
  for (i = 0; i < 64; ++i) {
    const ssize_t size = recv(node->socket, bytes, sizeof bytes, MSG_DONTWAIT);
    if (size < 0) return;
    if (!experimental_dual_arm_NodeCommand_receive(&node->command, &node->received, &node->order,
                                                   bytes, (uint32_t)size)) {
      continue;
    }
    node->arrival = now;
    node->has_command = 1;
  }
}

/* An axis with its servo, as in cpp/joint.hpp. */
static void move_axis(double* position, double* speed, double target) {
  *speed += 0.001 * (900 * (target - *position) - 60 * *speed);
  *position += 0.001 * *speed;
}

void arm_node_step(arm_node* node, uint64_t sample, int64_t now) {
  uint8_t bytes[STATE_BYTES];
  int is_following;
  int i;
  receive_commands(node, now);
  is_following = node->has_command && now - node->arrival <= lifespan && node->command.mode != 0;
  if (is_following) memcpy(node->target, node->command.target, sizeof node->target);
  /* The world has gone on in cycles that were skipped. */
  for (; node->next_sample <= sample; ++node->next_sample) {
    for (i = 0; i < 6; ++i) {
      move_axis(&node->state.position[i], &node->state.speed[i], node->target[i]);
    }
  }
  node->state.sample = sample;
  node->state.is_following = (uint8_t)is_following;
  node->sent.stamp = now;
  experimental_dual_arm_NodeState_frame(&node->state, &node->sent, bytes);
  /* A packet that is not taken is as one that is lost: the next says more. */
  (void)sendto(node->socket, bytes, sizeof bytes, MSG_DONTWAIT | MSG_NOSIGNAL,
               (const struct sockaddr*)&node->peer, sizeof node->peer);
}

void arm_node_close(arm_node* node) {
  if (node->socket >= 0) close(node->socket);
  node->socket = -1;
}
