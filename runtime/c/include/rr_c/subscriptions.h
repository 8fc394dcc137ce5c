/* SPDX-License-Identifier: Apache-2.0 */
#ifndef RR_C_SUBSCRIPTIONS_H
#define RR_C_SUBSCRIPTIONS_H

/** @file
 * Services that come and go: connections that are kept, with their wires, pipes and objects.
 * Included by rr.h. */

#include "filters.h"
#include "streams.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Keeps a connection to each of some services, and connects again when one is lost. Lasts until it
 * is closed or its node is shut down, whether or not a handle is held. */
typedef struct rr_service_subscription rr_service_subscription;

/** The client of a subscription that something comes from. */
typedef struct rr_subscribed_client {
  size_t size;     /**< sizeof(rr_subscribed_client), set by the caller */
  rr_node_id node; /**< of the service */
  rr_str service;  /**< the service's name */
} rr_subscribed_client;

/** How a subscription connects, and what is called. All zero but the size: the defaults. */
typedef struct rr_subscribe_options {
  size_t size;                /**< sizeof(rr_subscribe_options), set by the caller */
  rr_str username;            /**< these as in rr_connect_options */
  rr_str password;            /**< of `username` */
  rr_elements credentials;    /**< instead of the password, unless count is 0 */
  rr_str object_type;         /**< as in rr_connect_options */
  int32_t request_timeout_ms; /**< as in rr_connect_options */
  int32_t retry_delay_ms;     /**< from a failure to the next attempt; 0: 2.5 s */
  int32_t max_retry_delay_ms; /**< what it doubles up to while attempts fail; 0: it does not */
  int32_t connect_timeout_ms; /**< of an attempt; 0: 10 s */
  void* context;              /**< passed to the functions below */
  /** One at a time, in order. A client that is there already is told first. */
  void (*on_connected)(void* context, const rr_subscribed_client* client);
  /** A client has ended, and why. */
  void (*on_disconnected)(void* context, const rr_subscribed_client* client,
                          const rr_error_info* why);
  void (*on_failed)(void* context, const rr_error_info* why); /**< of an attempt */
  void (*drop)(void* context);     /**< behind the end of the subscription and of its handles */
  const rr_service_filter* filter; /**< minor version 3; may be NULL */
  /** 1: logs in without TLS also at URLs that discovery has found, which any host on the network
   * can announce. URLs from elsewhere are not asked about. */
  uint32_t allow_clear_credentials;
  uint32_t reserved; /**< 0 */
} rr_subscribe_options;

/** The URLs are alternatives of one service, tried in this order. Does not wait. */
RR_API rr_status rr_service_subscribe(rr_node* node, const rr_str* urls, size_t url_count,
                                      const rr_subscribe_options* options,
                                      rr_service_subscription** out_subscription, rr_error** error);
/** One service by its URLs. Minor version 3. */
typedef struct rr_service_urls {
  const rr_str* urls; /**< alternatives of one service */
  size_t url_count;   /**< of `urls` */
} rr_service_urls;
/** As rr_service_subscribe with several services (minor version 3). */
RR_API rr_status rr_service_subscribe_all(rr_node* node, const rr_service_urls* services,
                                          size_t service_count, const rr_subscribe_options* options,
                                          rr_service_subscription** out_subscription,
                                          rr_error** error);
/** The same with each service that discovery finds, whose root object has one of these types or
 * implements it, and that passes the filter; with type_count 0 of any type (minor version 3).
 * Listens with default options unless the node listens. */
RR_API rr_status rr_service_subscribe_types(rr_node* node, const rr_str* types, size_t type_count,
                                            const rr_subscribe_options* options,
                                            rr_service_subscription** out_subscription,
                                            rr_error** error);
/** Lets go of the handle, and of the functions; the subscription goes on. */
RR_API void rr_service_subscription_release(rr_service_subscription* subscription);
/** Ends the clients. Does not wait. */
RR_API void rr_service_subscription_close(rr_service_subscription* subscription);
/** 1 until the subscription is closed or its node is shut down. */
RR_API int32_t rr_service_subscription_is_open(const rr_service_subscription* subscription);
/** From now on these URLs, alternatives of one service. A connection stays while its URL is among
 * them. RR_INVALID_OPERATION when closed. */
RR_API rr_status rr_service_subscription_update_urls(rr_service_subscription* subscription,
                                                     const rr_str* urls, size_t url_count,
                                                     rr_error** error);
/** From now on these services. What stays among them stays connected. Minor version 3, as all
 * functions up to rr_service_subscription_root. RR_INVALID_OPERATION when closed. */
RR_API rr_status rr_service_subscription_update_services(rr_service_subscription* subscription,
                                                         const rr_service_urls* services,
                                                         size_t service_count, rr_error** error);
/** From now on services of these types that pass this filter, which may be NULL. What stays among
 * them stays connected. RR_INVALID_OPERATION when closed or made by URLs. */
RR_API rr_status rr_service_subscription_update_types(rr_service_subscription* subscription,
                                                      const rr_str* types, size_t type_count,
                                                      const rr_service_filter* filter,
                                                      rr_error** error);

/** Functions that rr_service_subscription_watch adds. */
typedef struct rr_service_subscription_handler {
  size_t size;   /**< sizeof(rr_service_subscription_handler), set by the caller */
  void* context; /**< passed to the functions below */
  /** As in rr_subscribe_options; on_failed also says of which service. */
  void (*on_connected)(void* context, const rr_subscribed_client* client);
  /** As in rr_subscribe_options. */
  void (*on_disconnected)(void* context, const rr_subscribed_client* client,
                          const rr_error_info* why);
  /** An attempt has failed: of the service that has these URLs, and why. */
  void (*on_failed)(void* context, const rr_str* urls, size_t url_count, const rr_error_info* why);
  void (*drop)(void* context); /**< last of all, once; see rr.h */
} rr_service_subscription_handler;
/** Further functions. They end with out_subscription. */
RR_API rr_status rr_service_subscription_watch(rr_service_subscription* subscription,
                                               const rr_service_subscription_handler* handler,
                                               rr_subscription** out_subscription,
                                               rr_error** error);
/** Calls `each` for each connected client, those that have been connected longest first, before it
 * returns. */
RR_API rr_status rr_service_subscription_clients(
    const rr_service_subscription* subscription, void* context,
    void (*each)(void* context, const rr_subscribed_client* client), rr_error** error);
/** The root object of one of them. RR_CONNECTION_ERROR when it is not connected. */
RR_API rr_status rr_service_subscription_client_root(rr_service_subscription* subscription,
                                                     const rr_subscribed_client* client,
                                                     rr_object** out_object, rr_error** error);
/** The state of one service. */
typedef struct rr_subscribed_service {
  size_t size;                        /**< sizeof(rr_subscribed_service), set by the caller */
  const rr_str* urls;                 /**< of the service, in the order in which they are tried */
  size_t url_count;                   /**< of `urls` */
  const rr_subscribed_client* client; /**< NULL unless it is connected */
  const rr_error_info* last_error; /**< why it is not, once an attempt has ended; otherwise NULL */
  uint64_t failures;               /**< of attempts since it was last connected */
} rr_subscribed_service;
/** Calls `each` for each service, connected or not, before it returns. */
RR_API rr_status rr_service_subscription_services(
    const rr_service_subscription* subscription, void* context,
    void (*each)(void* context, const rr_subscribed_service* service), rr_error** error);
/** The root object of the client that has been connected longest. It belongs to one connection:
 * when that is lost its calls fail, and the next client has another. wait_ms: 0 does not wait, and
 * RR_CONNECTION_ERROR says why there is none; otherwise RR_OPERATION_TIMEOUT does. */
RR_API rr_status rr_service_subscription_root(rr_service_subscription* subscription,
                                              int32_t wait_ms, rr_object** out_object,
                                              rr_error** error);

/** A wire of the object at a path, at all clients that are connected. Lasts until it is closed or
 * the subscription is. Paths begin with the name of the service or with `*`, which stands for it;
 * empty means the root. */
typedef struct rr_wire_subscription rr_wire_subscription;
/** An endpoint of a pipe of the object at a path, at all clients that are connected. Lasts as
 * rr_wire_subscription. */
typedef struct rr_pipe_subscription rr_pipe_subscription;

/** Connects the wire at each client, now and later. `path` as in rr_wire_subscription. Does not
 * wait. */
RR_API rr_status rr_wire_subscribe(rr_service_subscription* subscription, rr_str member,
                                   rr_str path, rr_wire_subscription** out_wire, rr_error** error);
/** Releases the handle, and its function; the subscription of the wire goes on. NULL is allowed. */
RR_API void rr_wire_subscription_release(rr_wire_subscription* wire);
/** Disconnects the wire at all clients. Does not wait. */
RR_API void rr_wire_subscription_close(rr_wire_subscription* wire);
/** Sends a value to all clients that are connected now; stores to how many. `out_count` may be
 * NULL, here and below. */
RR_API rr_status rr_wire_subscription_send(rr_wire_subscription* wire, const rr_elements* value,
                                           size_t* out_count, rr_error** error);
/** The value that has come last, from whichever client. RR_VALUE_NOT_SET for none. */
RR_API rr_status rr_wire_subscription_received(const rr_wire_subscription* wire,
                                               rr_data** out_value, rr_time* out_time,
                                               rr_error** error);
/** Waits until there is a value. 0 when the time was over, or the subscription closed, before. */
RR_API int32_t rr_wire_subscription_wait(const rr_wire_subscription* wire, int32_t timeout_ms);
/** Notified of a value: as on_value below. */
typedef void (*rr_each_value)(void* context, const rr_subscribed_client* client,
                              const rr_elements* value, const rr_time* time, rr_data* data);
/** Calls `each` once with the value that has come last, before it returns. RR_VALUE_NOT_SET for
 * none. Minor version 3, as the following three. */
RR_API rr_status rr_wire_subscription_newest(const rr_wire_subscription* wire, void* context,
                                             rr_each_value each, rr_error** error);
/** The same for the newest value of each connected client that has one. */
RR_API rr_status rr_wire_subscription_values(const rr_wire_subscription* wire, void* context,
                                             rr_each_value each, rr_error** error);
/** Calls `each` for each client at which the wire is connected. */
RR_API rr_status rr_wire_subscription_clients(const rr_wire_subscription* wire, void* context,
                                              void (*each)(void* context,
                                                           const rr_subscribed_client* client),
                                              rr_error** error);
/** A value that came longer ago is as none; 0: values never expire. */
RR_API rr_status rr_wire_subscription_set_lifespan(rr_wire_subscription* wire, int32_t lifespan_ms,
                                                   rr_error** error);
/** What is called for values of a wire. Threads of the node, one at a time. */
typedef struct rr_wire_subscription_handler {
  size_t size;   /**< sizeof(rr_wire_subscription_handler), set by the caller */
  void* context; /**< passed to the functions below */
  /** needed: a value has come from this client */
  void (*on_value)(void* context, const rr_subscribed_client* client, const rr_elements* value,
                   const rr_time* time, rr_data* data); /**< needed */
  void (*drop)(void* context);                          /**< last of all, once; see rr.h */
} rr_wire_subscription_handler;
/** Replaces the function that was set on this handle before; NULL: none. It ends with the handle.
 */
RR_API rr_status rr_wire_subscription_set_handler(rr_wire_subscription* wire,
                                                  const rr_wire_subscription_handler* handler,
                                                  rr_error** error);

/** The object at a path, which is looked for when a client comes. Lasts as those above. */
typedef struct rr_object_subscription rr_object_subscription;
/** Keeps the object at a path. `path` as in rr_wire_subscription. Does not wait. */
RR_API rr_status rr_object_subscribe(rr_service_subscription* subscription, rr_str path,
                                     rr_object_subscription** out_object, rr_error** error);
/** Releases the handle; the subscription goes on. NULL is allowed. */
RR_API void rr_object_subscription_release(rr_object_subscription* object);
/** Ends the subscription of the object. Objects that were got stay usable. */
RR_API void rr_object_subscription_close(rr_object_subscription* object);
/** The object of the client that is connected; otherwise as rr_service_subscription_root. */
RR_API rr_status rr_object_subscription_get(const rr_object_subscription* object, int32_t wait_ms,
                                            rr_object** out_object, rr_error** error);

/** Connects an endpoint at each client, now and later. When more than `max_received` packets wait
 * the oldest is lost; 0: no limit. Does not wait. */
RR_API rr_status rr_pipe_subscribe(rr_service_subscription* subscription, rr_str member,
                                   rr_str path, size_t max_received,
                                   rr_pipe_subscription** out_pipe, rr_error** error);
/** Releases the handle, and its function; the subscription of the pipe goes on. NULL is allowed. */
RR_API void rr_pipe_subscription_release(rr_pipe_subscription* pipe);
/** Disconnects the endpoints at all clients. Does not wait. */
RR_API void rr_pipe_subscription_close(rr_pipe_subscription* pipe);
/** Sends a packet to all clients that are connected now; stores to how many. `out_count` may be
 * NULL. */
RR_API rr_status rr_pipe_subscription_send(rr_pipe_subscription* pipe, const rr_elements* packet,
                                           size_t* out_count, rr_error** error);
/** The packet that has waited longest, or NULL for none. */
RR_API rr_status rr_pipe_subscription_receive(rr_pipe_subscription* pipe, rr_data** out_packet,
                                              rr_error** error);
/** Calls `each` once with the packet that has waited longest, and from which client it came, before
 * it returns; not when none waits (minor version 3). */
RR_API rr_status rr_pipe_subscription_take(rr_pipe_subscription* pipe, void* context,
                                           void (*each)(void* context,
                                                        const rr_subscribed_client* client,
                                                        const rr_elements* packet, rr_data* data),
                                           rr_error** error);
/** Calls `each` for each client at which an endpoint is connected (minor version 3). */
RR_API rr_status rr_pipe_subscription_clients(const rr_pipe_subscription* pipe, void* context,
                                              void (*each)(void* context,
                                                           const rr_subscribed_client* client),
                                              rr_error** error);
/** Waits until a packet is there. 0 when the time was over, or the subscription closed, before. */
RR_API int32_t rr_pipe_subscription_wait(const rr_pipe_subscription* pipe, int32_t timeout_ms);
/** What is called for packets of a pipe. Threads of the node, one at a time. */
typedef struct rr_pipe_subscription_handler {
  size_t size;   /**< sizeof(rr_pipe_subscription_handler), set by the caller */
  void* context; /**< passed to the functions below */
  /** Packets that wait, and those that come, in order, instead of being kept. */
  void (*on_packet)(void* context, const rr_subscribed_client* client, const rr_elements* packet,
                    rr_data* data); /**< needed */
  void (*drop)(void* context);      /**< last of all, once; see rr.h */
} rr_pipe_subscription_handler;
/** Replaces the function that was set on this handle before; NULL: none, and packets are kept
 * again. It ends with the handle. */
RR_API rr_status rr_pipe_subscription_set_handler(rr_pipe_subscription* pipe,
                                                  const rr_pipe_subscription_handler* handler,
                                                  rr_error** error);

/** Services that match, without connections to them (minor version 3). Lasts until it is closed or
 * its node is shut down. */
typedef struct rr_service_info_subscription rr_service_info_subscription;
/** What is called for services that come and go. Threads of the node. */
typedef struct rr_service_info_handler {
  size_t size;   /**< sizeof(rr_service_info_handler), set by the caller */
  void* context; /**< passed to the functions below */
  /** One at a time, in order. Services that are there already come first. */
  void (*on_detected)(void* context, const rr_found_service* service);
  void (*on_changed)(void* context, const rr_found_service* service); /**< attributes or URLs */
  /** The service is not there any more. */
  void (*on_lost)(void* context, const rr_found_service* service);
  void (*drop)(void* context); /**< last of all, once; see rr.h */
} rr_service_info_handler;
/** Types and filter as in rr_service_subscribe_types; filter and handler may be NULL. */
RR_API rr_status rr_service_info_subscribe(rr_node* node, const rr_str* types, size_t type_count,
                                           const rr_service_filter* filter,
                                           const rr_service_info_handler* handler,
                                           rr_service_info_subscription** out_subscription,
                                           rr_error** error);
/** Lets go of the handle, and of the functions; the subscription goes on. */
RR_API void rr_service_info_subscription_release(rr_service_info_subscription* subscription);
/** Ends the subscription; its functions are not called any more. Does not wait. */
RR_API void rr_service_info_subscription_close(rr_service_info_subscription* subscription);
/** 1 until the subscription is closed or its node is shut down. */
RR_API int32_t
rr_service_info_subscription_is_open(const rr_service_info_subscription* subscription);
/** Those that are there now. */
RR_API rr_status
rr_service_info_subscription_services(const rr_service_info_subscription* subscription,
                                      rr_found_services** out_services, rr_error** error);
/** Further functions. They end with out_subscription. */
RR_API rr_status rr_service_info_subscription_watch(rr_service_info_subscription* subscription,
                                                    const rr_service_info_handler* handler,
                                                    rr_subscription** out_subscription,
                                                    rr_error** error);

#ifdef __cplusplus
}
#endif

#endif
