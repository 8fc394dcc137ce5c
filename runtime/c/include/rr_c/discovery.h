/* SPDX-License-Identifier: Apache-2.0 */
#ifndef RR_C_DISCOVERY_H
#define RR_C_DISCOVERY_H

/** @file
 * Finding other nodes and their services, and being found (minor version 3). Included by rr.h.
 * docs/howto/discovery.md says how nodes find each other. */

#include "node.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Where packets are sent and received. */
enum {
  RR_NODE_LOCAL = 1,    /**< ff01::ba86: this machine */
  RR_LINK_LOCAL = 2,    /**< ff02::ba86 */
  RR_SITE_LOCAL = 4,    /**< ff05::ba86 */
  RR_IPV4_BROADCAST = 8 /**< 255.255.255.255: a node that listens hears IPv4 in any case */
};

/** How a node announces itself. All zero but the size: the defaults. */
typedef struct rr_announce_options {
  size_t size;              /**< sizeof(rr_announce_options), set by the caller */
  uint32_t networks;        /**< RR_NODE_LOCAL ...; 0: RR_LINK_LOCAL */
  uint32_t port;            /**< 0: 48653. Nodes find those with the same port only. */
  const rr_str* interfaces; /**< names of the interfaces to send from; none: all that are up */
  size_t interface_count;   /**< 0: all */
  int32_t period_ms; /**< from one announcement to the next; 0: 55 s, otherwise 500 ms at least */
  uint32_t reserved; /**< 0 */
} rr_announce_options;
/** Announces all TCP addresses at which the node listens, now and later, each period and when its
 * services change. While it listens it also answers requests. Replaces earlier options. `options`
 * may be NULL here and below. RR_INVALID_OPERATION after the node's shutdown, here and below. */
RR_API rr_status rr_discovery_announce(rr_node* node, const rr_announce_options* options,
                                       rr_error** error);
/** Ends announcing. Nodes that know this one forget it when its announcement has run out. */
RR_API void rr_discovery_stop_announcing(rr_node* node);

/** What a node listens to, and what it keeps. All zero but the size: the defaults. */
typedef struct rr_listen_options {
  size_t size;              /**< sizeof(rr_listen_options), set by the caller */
  uint32_t networks;        /**< these as in rr_announce_options */
  uint32_t port;            /**< as in rr_announce_options */
  const rr_str* interfaces; /**< as in rr_announce_options */
  size_t interface_count;   /**< 0: all */
  int32_t lifetime_ms;      /**< a URL is forgotten so long after its last announcement; 0: 60 s */
  uint32_t without_local_nodes; /**< 1: files of local sockets on this machine are not looked at */
  size_t max_nodes;             /**< that are kept; 0: 4096 */
  size_t max_nodes_of_sender;   /**< of these, nodes that one address announced first; 0: 256 */
} rr_listen_options;
/** Listens to announcements and requests, and asks all nodes for theirs. Replaces earlier options,
 * and then forgets all nodes. RR_CONNECTION_ERROR when the port cannot be used. */
RR_API rr_status rr_discovery_listen(rr_node* node, const rr_listen_options* options,
                                     rr_error** error);
/** Also forgets all nodes. */
RR_API void rr_discovery_stop_listening(rr_node* node);
/** 1 while the node listens, 0 otherwise. */
RR_API int32_t rr_discovery_is_listening(const rr_node* node);
/** Asks all nodes to announce themselves: three packets within three seconds. RR_INVALID_OPERATION
 * unless the node listens. */
RR_API rr_status rr_discovery_request(rr_node* node, rr_error** error);

/** A node that has announced itself. Nothing of it is proven. */
typedef struct rr_detected_node {
  size_t size;   /**< sizeof(rr_detected_node), set by the caller */
  rr_node_id id; /**< as it says; zero for none */
  rr_str name;   /**< empty for none */
  const rr_str*
      urls; /**< of its service index; as a result of rr_discovery_find_node...: of the node */
  size_t url_count; /**< of `urls` */
} rr_detected_node;

/** A service that may be connected to, by what is known of it. */
typedef struct rr_found_service {
  size_t size;              /**< sizeof(rr_found_service), set by the caller */
  rr_str name;              /**< as it is registered */
  rr_node_id node;          /**< zero while unknown */
  rr_str node_name;         /**< empty for none, and while unknown */
  const rr_str* urls;       /**< all by which it may be reached, to be tried in this order */
  size_t url_count;         /**< of `urls` */
  rr_str object_type;       /**< of its root object, qualified */
  const rr_str* implements; /**< qualified, without object_type itself */
  size_t implement_count;   /**< of `implements` */
  rr_elements attributes;   /**< one element: a map of strings to varvalues. Version 4. */
} rr_found_service;

/** Nodes that a search has found. What is read of them is valid until the release. */
typedef struct rr_detected_nodes rr_detected_nodes;
/** How many nodes there are. */
RR_API size_t rr_detected_nodes_count(const rr_detected_nodes* nodes);
/** Fills `*info`, whose size is set. RR_OUT_OF_RANGE when `place` is not below the count. */
RR_API rr_status rr_detected_nodes_read(const rr_detected_nodes* nodes, size_t place,
                                        rr_detected_node* info, rr_error** error);
/** Releases the result and all that was read from it. NULL is allowed. */
RR_API void rr_detected_nodes_release(rr_detected_nodes* nodes);

/** Services that a search has found. What is read of them is valid until the release. */
typedef struct rr_found_services rr_found_services;
/** How many services there are. */
RR_API size_t rr_found_services_count(const rr_found_services* services);
/** As rr_detected_nodes_read: fills `*info`, whose size is set. RR_OUT_OF_RANGE when `place` is not
 * below the count. */
RR_API rr_status rr_found_services_read(const rr_found_services* services, size_t place,
                                        rr_found_service* info, rr_error** error);
/** Releases the result and all that was read from it. NULL is allowed. */
RR_API void rr_found_services_release(rr_found_services* services);

/** The nodes that are known now. */
RR_API rr_status rr_discovery_nodes(const rr_node* node, rr_detected_nodes** out_nodes,
                                    rr_error** error);

/** What is called for nodes that come and go. Threads of the node, under no lock. */
typedef struct rr_discovery_handler {
  size_t size;   /**< sizeof(rr_discovery_handler), set by the caller */
  void* context; /**< passed to the functions below */
  /** One at a time, in order. Nodes that are known already come first. */
  void (*on_detected)(void* context, const rr_detected_node* node); /**< a node is new */
  void (*on_lost)(void* context, const rr_detected_node* node); /**< all its URLs are forgotten */
  void (*drop)(void* context);                                  /**< last of all, once; see rr.h */
} rr_discovery_handler;
/** Until the subscription is released. The functions are dropped then, or after the node's end. */
RR_API rr_status rr_discovery_watch(rr_node* node, const rr_discovery_handler* handler,
                                    rr_subscription** out_subscription, rr_error** error);

/** How a search is made. All zero but the size: the defaults. */
typedef struct rr_find_options {
  size_t size;           /**< sizeof(rr_find_options), set by the caller */
  const rr_str* schemes; /**< `rr+tcp`, ...: URLs of others, and what has none left, are left out */
  size_t scheme_count;   /**< 0: all */
  int32_t wait_ms;    /**< nodes are asked, and given so long to answer; 0: what is known is used */
  int32_t timeout_ms; /**< for the answers of all service indexes together; 0: 5 s, RR_NO_LIMIT */
  const rr_cancellation* cancellation; /**< may be NULL; may be released when the call has begun */
} rr_find_options;

/* These listen with default options unless the node listens already. They block;
 * RR_OPERATION_CANCELLED when they are cancelled or the node is shut down meanwhile. */

/** Services whose root object has one of these types or implements it. With type_count 0 all
 * services, the service indexes themselves included. */
RR_API rr_status rr_discovery_find_services(rr_node* node, const rr_str* types, size_t type_count,
                                            const rr_find_options* options,
                                            rr_found_services** out_services, rr_error** error);
/** The node of this id; none or one. */
RR_API rr_status rr_discovery_find_node(rr_node* node, rr_node_id id,
                                        const rr_find_options* options,
                                        rr_detected_nodes** out_nodes, rr_error** error);
/** All nodes of this name. */
RR_API rr_status rr_discovery_find_nodes(rr_node* node, rr_str name, const rr_find_options* options,
                                         rr_detected_nodes** out_nodes, rr_error** error);
/** As rr_discovery_nodes, after asking and waiting for wait_ms. Schemes and timeout_ms do not
 * matter. */
RR_API rr_status rr_discovery_update_nodes(rr_node* node, const rr_find_options* options,
                                           rr_detected_nodes** out_nodes, rr_error** error);

/** rr_discovery_find_services without waiting, on a thread of its own. Result: rr_found_services*.
 */
RR_API rr_status rr_discovery_find_services_async(rr_node* node, const rr_str* types,
                                                  size_t type_count, const rr_find_options* options,
                                                  const rr_completion* completion,
                                                  rr_error** error);
/** rr_discovery_find_node without waiting, on a thread of its own. Result: rr_detected_nodes*. */
RR_API rr_status rr_discovery_find_node_async(rr_node* node, rr_node_id id,
                                              const rr_find_options* options,
                                              const rr_completion* completion, rr_error** error);
/** rr_discovery_find_nodes without waiting, on a thread of its own. Result: rr_detected_nodes*. */
RR_API rr_status rr_discovery_find_nodes_async(rr_node* node, rr_str name,
                                               const rr_find_options* options,
                                               const rr_completion* completion, rr_error** error);
/** rr_discovery_update_nodes without waiting, on a thread of its own. Result: rr_detected_nodes*.
 */
RR_API rr_status rr_discovery_update_nodes_async(rr_node* node, const rr_find_options* options,
                                                 const rr_completion* completion, rr_error** error);

#ifdef __cplusplus
}
#endif

#endif
