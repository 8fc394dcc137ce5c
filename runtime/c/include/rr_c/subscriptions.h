/* SPDX-License-Identifier: Apache-2.0 */
#ifndef RR_C_SUBSCRIPTIONS_H
#define RR_C_SUBSCRIPTIONS_H

/* Services that come and go: connections that are kept, with their wires, pipes and objects.
 * Included by rr.h. */

#include "streams.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Keeps a connection to a service, and connects again when it is lost. Lasts until it is closed or
 * its node is shut down, whether or not somebody holds a handle. */
typedef struct rr_service_subscription rr_service_subscription;

/* The client of a subscription that something comes from. */
typedef struct rr_subscribed_client {
  size_t size;
  rr_node_id node;
  rr_str service;
} rr_subscribed_client;

typedef struct rr_subscribe_options {
  size_t size;
  rr_str username; /* these as in rr_connect_options */
  rr_str password;
  rr_elements credentials;
  rr_str object_type;
  int32_t request_timeout_ms;
  int32_t retry_delay_ms;     /* from a failure to the next attempt; 0: 2.5 s */
  int32_t max_retry_delay_ms; /* what it doubles up to while attempts fail; 0: it does not */
  int32_t connect_timeout_ms; /* of an attempt; 0: 10 s */
  void* context;
  /* One at a time, in order. A client that is there already is told first. */
  void (*on_connected)(void* context, const rr_subscribed_client* client);
  void (*on_disconnected)(void* context, const rr_subscribed_client* client,
                          const rr_error_info* why);
  void (*on_failed)(void* context, const rr_error_info* why); /* of an attempt */
  void (*drop)(void* context); /* behind the end of the subscription and of its handles */
} rr_subscribe_options;

/* The URLs are alternatives of one service, tried in this order. Does not wait. */
RR_API rr_status rr_service_subscribe(rr_node* node, const rr_str* urls, size_t url_count,
                                      const rr_subscribe_options* options,
                                      rr_service_subscription** out_subscription, rr_error** error);
/* Lets go of the handle, and of the functions; the subscription goes on. */
RR_API void rr_service_subscription_release(rr_service_subscription* subscription);
/* Ends the client. Does not wait. */
RR_API void rr_service_subscription_close(rr_service_subscription* subscription);
RR_API int32_t rr_service_subscription_is_open(const rr_service_subscription* subscription);
RR_API rr_status rr_service_subscription_update_urls(rr_service_subscription* subscription,
                                                     const rr_str* urls, size_t url_count,
                                                     rr_error** error);
/* The root object of the client that is connected. It belongs to one connection: when that is lost
 * its calls fail, and the next client has another. wait_ms: 0 does not wait, and
 * RR_CONNECTION_ERROR says why there is none; otherwise RR_OPERATION_TIMEOUT does. */
RR_API rr_status rr_service_subscription_root(rr_service_subscription* subscription,
                                              int32_t wait_ms, rr_object** out_object,
                                              rr_error** error);

/* A wire, or a pipe's endpoint, of the object at a path at whichever client is connected. Lasts
 * until it is closed or the subscription is. Paths begin with the name of the service or with `*`,
 * which stands for it; empty means the root. */
typedef struct rr_wire_subscription rr_wire_subscription;
typedef struct rr_pipe_subscription rr_pipe_subscription;

RR_API rr_status rr_wire_subscribe(rr_service_subscription* subscription, rr_str member,
                                   rr_str path, rr_wire_subscription** out_wire, rr_error** error);
RR_API void rr_wire_subscription_release(rr_wire_subscription* wire);
RR_API void rr_wire_subscription_close(rr_wire_subscription* wire);
/* Sends a value to all clients that are connected now; stores to how many. `out_count` may be NULL,
 * here and below. */
RR_API rr_status rr_wire_subscription_send(rr_wire_subscription* wire, const rr_elements* value,
                                           size_t* out_count, rr_error** error);
/* The value that has come last. RR_VALUE_NOT_SET for none. */
RR_API rr_status rr_wire_subscription_received(const rr_wire_subscription* wire,
                                               rr_data** out_value, rr_time* out_time,
                                               rr_error** error);
RR_API int32_t rr_wire_subscription_wait(const rr_wire_subscription* wire, int32_t timeout_ms);
typedef struct rr_wire_subscription_handler {
  size_t size;
  void* context;
  void (*on_value)(void* context, const rr_subscribed_client* client, const rr_elements* value,
                   const rr_time* time, rr_data* data); /* needed */
  void (*drop)(void* context);
} rr_wire_subscription_handler;
/* Replaces the function that was set on this handle before; NULL: none. It ends with the handle. */
RR_API rr_status rr_wire_subscription_set_handler(rr_wire_subscription* wire,
                                                  const rr_wire_subscription_handler* handler,
                                                  rr_error** error);

/* The object at a path, which is looked for when a client comes. Lasts as those above. */
typedef struct rr_object_subscription rr_object_subscription;
RR_API rr_status rr_object_subscribe(rr_service_subscription* subscription, rr_str path,
                                     rr_object_subscription** out_object, rr_error** error);
RR_API void rr_object_subscription_release(rr_object_subscription* object);
RR_API void rr_object_subscription_close(rr_object_subscription* object);
/* The object of the client that is connected; otherwise as rr_service_subscription_root. */
RR_API rr_status rr_object_subscription_get(const rr_object_subscription* object, int32_t wait_ms,
                                            rr_object** out_object, rr_error** error);

/* When more than `max_received` packets wait the oldest is lost; 0: no limit. */
RR_API rr_status rr_pipe_subscribe(rr_service_subscription* subscription, rr_str member,
                                   rr_str path, size_t max_received,
                                   rr_pipe_subscription** out_pipe, rr_error** error);
RR_API void rr_pipe_subscription_release(rr_pipe_subscription* pipe);
RR_API void rr_pipe_subscription_close(rr_pipe_subscription* pipe);
RR_API rr_status rr_pipe_subscription_send(rr_pipe_subscription* pipe, const rr_elements* packet,
                                           size_t* out_count, rr_error** error);
/* The packet that has waited longest, or NULL for none. */
RR_API rr_status rr_pipe_subscription_receive(rr_pipe_subscription* pipe, rr_data** out_packet,
                                              rr_error** error);
RR_API int32_t rr_pipe_subscription_wait(const rr_pipe_subscription* pipe, int32_t timeout_ms);
typedef struct rr_pipe_subscription_handler {
  size_t size;
  void* context;
  /* Packets that wait, and those that come, in order, instead of being kept. */
  void (*on_packet)(void* context, const rr_subscribed_client* client, const rr_elements* packet,
                    rr_data* data); /* needed */
  void (*drop)(void* context);
} rr_pipe_subscription_handler;
RR_API rr_status rr_pipe_subscription_set_handler(rr_pipe_subscription* pipe,
                                                  const rr_pipe_subscription_handler* handler,
                                                  rr_error** error);

#ifdef __cplusplus
}
#endif

#endif
