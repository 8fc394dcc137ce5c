/* SPDX-License-Identifier: Apache-2.0 */
#ifndef RR_C_NODE_H
#define RR_C_NODE_H

/** @file
 * Nodes and connecting. Included by rr.h. */

#include "security.h"
#include "values.h"

#ifdef __cplusplus
extern "C" {
#endif

/** One participant: offers services, and connects to those of others. */
typedef struct rr_node rr_node;

/** Levels of the log: RR_LOG_DEBUG, RR_LOG_INFO, RR_LOG_WARNING and RR_LOG_ERROR, from chatter to
 * trouble. */
enum { RR_LOG_DEBUG = 0, RR_LOG_INFO = 1, RR_LOG_WARNING = 2, RR_LOG_ERROR = 3 };

/** What a node does not offer the other side of a new connection (04, section 4.4). */
enum {
  RR_WITHOUT_V4 = 1,              /**< only the older message format */
  RR_WITHOUT_STRING_TABLE = 2,    /**< names are sent as texts, never as codes of a table */
  RR_WITHOUT_COMBINED_CONNECT = 4 /**< connecting takes a request for each step */
};

/** Zero: as an rr::Node has it (runtime/cpp/include/rr/options.hpp). Times are milliseconds. */
typedef struct rr_node_options {
  size_t size; /**< sizeof(rr_node_options), set by the caller */
  /** Of the node: letters, digits, underscores, points and hyphens, a letter first. Empty for none.
   */
  rr_str name;
  rr_node_id id;                                           /**< zero: a random one */
  void* context;                                           /**< passed to the functions below */
  void (*log)(void* context, uint32_t level, rr_str text); /**< on any thread */
  void (*drop)(void* context); /**< when nothing of the node is left, handles of clients included */
  uint32_t client_without;     /**< RR_WITHOUT_... */
  uint32_t server_without;     /**< RR_WITHOUT_..., for connections that others make */
  uint32_t server_string_table; /**< 1: servers offer it, which they do not by default */
  uint32_t max_threads;         /**< of the node, for handlers that block; 128 */
  /** Of a call; 0: 15 s. RR_NO_LIMIT here and below, too. */
  int32_t request_timeout_ms;
  int32_t connect_timeout_ms;       /**< from looking up the host to the first message; 5 s */
  int32_t first_message_timeout_ms; /**< of a server, for a client's first whole message; 5 s */
  /** a side that is silent for so long sends a connection test; 10 s */
  int32_t heartbeat_period_ms;
  /** nothing has come for so long after something was sent: the connection is given up; 15 s */
  int32_t receive_timeout_ms;
  int32_t keep_alive_period_ms; /**< a client that is silent for so long tells its service; 60 s */
  int32_t client_timeout_ms;    /**< a service drops clients that are silent for so long; 600 s */
  /** a service drops generators that are unused for so long; 600 s */
  int32_t generator_timeout_ms;
  uint32_t message_size;          /**< largest message, bytes */
  uint32_t memory_transfer_limit; /**< bytes */
  uint64_t send_queue_limit;      /**< bytes */
  uint64_t request_queue_limit;   /**< bytes */
  uint64_t max_connections;       /**< that may be open to this node at once; 0: any number */
  const rr_tls_options* tls;      /**< minor version 4, as the next; may be NULL */
  const rr_audit_options* audit;  /**< may be NULL */
  /** 1: messages and wires of `rr+local` go through memory that both nodes map, where both have
   * this (minor version 5, as the next; docs/reference/shared_memory.md). */
  uint32_t shared_memory;
  /** For so long a thread that waits for a message looks for it before it sleeps, with shared
   * memory only: microseconds, 1000 at most. */
  uint32_t spin_us;
} rr_node_options;

/** `options` may be NULL. */
RR_API rr_status rr_node_new(const rr_node_options* options, rr_node** out_node, rr_error** error);
/** As rr_node_shutdown, and lets go of the node. On a thread of the node it does not wait: then its
 * functions may still run for a while. */
RR_API void rr_node_release(rr_node* node);
/** Ends all services, clients and connections, and waits for the functions that run and for those
 * that are still to be told (completions, on_closed, drop of what has ended). On a thread of the
 * node it does not wait. May be called again. */
RR_API void rr_node_shutdown(rr_node* node);

/** The id of the node: the one of its options, of its certificate, or a random one. */
RR_API rr_node_id rr_node_get_id(const rr_node* node);
/** Valid while the node is. */
RR_API rr_str rr_node_get_name(const rr_node* node);

/** Accepts connections at `rr+tcp://host:port`, port 0 meaning any; a host of `*`, or none, means
 * all addresses. `out_port` may be NULL. */
RR_API rr_status rr_node_listen(rr_node* node, rr_str url, uint16_t* out_port, rr_error** error);
/** Where a service may be reached: one URL a line. Text. */
RR_API rr_status rr_node_urls(const rr_node* node, rr_str service, rr_data** out_data,
                              rr_error** error);
/** Serves one end of a connected stream socket, which is taken over. */
RR_API rr_status rr_node_adopt(rr_node* node, int descriptor, rr_error** error);

/** A session with a service. */
typedef struct rr_client rr_client;

/** How a client connects. All zero but the size: the defaults. */
typedef struct rr_connect_options {
  size_t size;     /**< sizeof(rr_connect_options), set by the caller */
  rr_str username; /**< of a service that has users */
  rr_str password; /**< sent as the credential `password` */
  rr_elements
      credentials; /**< instead of the password, unless count is 0: a map of strings to varvalues */
  rr_str object_type;         /**< what the root must be or implement, qualified; empty: anything */
  int32_t request_timeout_ms; /**< of all calls; 0: the node's; RR_NO_LIMIT */
  /** 1: logs in without TLS also at a URL that discovery has found, which any host on the network
   * can announce. URLs from elsewhere are not asked about (minor version 4). */
  uint32_t allow_clear_credentials;
  void* context; /**< passed to the functions below */
  /** Once, when either side has ended the session: RR_OPERATION_ABORTED for this side,
   * RR_CONNECTION_ERROR for a lost connection or a service that sends this client away,
   * RR_SERVICE_NOT_FOUND for a service that was closed. Not when connecting has failed. */
  void (*on_closed)(void* context, const rr_error_info* why);
  /** The service has released the object at a path, and all below it. */
  void (*on_path_released)(void* context, rr_str path);
  void (*drop)(void* context); /**< last of all, once; see rr.h */
} rr_connect_options;

/** Connects to the service at a URL. With several they are tried in order, and the last one's
 * failure is told. `options` may be NULL. */
RR_API rr_status rr_client_connect(rr_node* node, const rr_str* urls, size_t url_count,
                                   const rr_connect_options* options, rr_client** out_client,
                                   rr_error** error);
/** Result: rr_client*. On a thread of its own. The options are copied. */
RR_API rr_status rr_client_connect_async(rr_node* node, const rr_str* urls, size_t url_count,
                                         const rr_connect_options* options,
                                         const rr_completion* completion, rr_error** error);

#ifdef __cplusplus
}
#endif

#endif
