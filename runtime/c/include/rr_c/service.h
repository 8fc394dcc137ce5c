/* SPDX-License-Identifier: Apache-2.0 */
#ifndef RR_C_SERVICE_H
#define RR_C_SERVICE_H

/** @file
 * The service's side: definitions, tables of members, objects, services, users. Included by rr.h. /
 */

#include "streams.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Definitions and tables. */

/** A definition's text. Counted: what uses it keeps it. */
typedef struct rr_definition rr_definition;
/** The text of the file, exactly as clients are to get it, and the definitions that it imports,
 * each named in it. RR_SERVICE_DEFINITION_ERROR when a name does not fit. */
RR_API rr_status rr_definition_new(rr_str text, rr_definition* const* imports, size_t import_count,
                                   rr_definition** out_definition, rr_error** error);
/** Releases this reference. What uses the definition keeps it. NULL is allowed. */
RR_API void rr_definition_release(rr_definition* definition);

/** Kinds of members. */
enum {
  RR_PROPERTY = 0, /**< a value that clients get and set */
  RR_FUNCTION = 1, /**< what clients call */
  RR_EVENT = 2,    /**< what the service notifies clients of */
  RR_OBJREF = 3,   /**< a reference to another object */
  RR_PIPE = 4,     /**< packets in order, both ways */
  RR_CALLBACK = 5, /**< what the service calls at one client */
  RR_WIRE = 6,     /**< a value of which only the newest counts */
  RR_MEMORY = 7    /**< an array that is read and written in parts */
};

/** How a function gives a generator: not, one that gives values, one that takes them, or both. */
enum {
  RR_NO_GENERATOR = 0,      /**< the function gives a value or nothing */
  RR_GENERATOR_RETURNS = 1, /**< each step gives a value */
  RR_GENERATOR_TAKES = 2,   /**< each step takes a value */
  RR_GENERATOR_BOTH = 3     /**< each step takes a value and gives one */
};

/** One member of an object. Fields that its kind does not name are zero. */
typedef struct rr_member {
  rr_str name;            /**< as in the definition */
  uint32_t kind;          /**< RR_PROPERTY ... */
  uint32_t access;        /**< modifiers */
  uint32_t returns_value; /**< function, callback: 0 for void */
  uint32_t generator;     /**< function */
  uint32_t index;         /**< objref: RR_INDEX_... */
  uint32_t reserved;      /**< 0 */
  rr_str object_type;     /**< objref: qualified, empty for varobject */
  rr_memory_type memory;  /**< memory */
  /** Pipe, wire (minor version 1): whether a value that a client sends or pokes is one of the
   * member's type. What is not RR_OK is answered to a poke, and a packet or value that was sent is
   * dropped, as if it had not been (07, section 13). Called by the thread that reads the
   * connection, for several at once; it only looks at the value, and calls nothing of this
   * interface. NULL: any value is taken. */
  rr_status (*check)(void* check_context, const rr_elements* value);
  void* check_context; /**< stays as long as the table */
} rr_member;

/** The table of an object's members, those of what it implements included. Counted, as definitions.
 */
typedef struct rr_object_type rr_object_type;
/** `name` is that of the object in the definition, without the definition's. What it implements is
 * read from the text. `member_size` is sizeof(rr_member), also of an older version. */
RR_API rr_status rr_object_type_new(rr_definition* definition, rr_str name,
                                    const rr_member* members, size_t member_count,
                                    size_t member_size, rr_object_type** out_type,
                                    rr_error** error);
/** Releases this reference. What uses the table keeps it. NULL is allowed. */
RR_API void rr_object_type_release(rr_object_type* type);

/* Objects. */

/** An object that services offer. It lives while a handle or a service has it; then it is dropped.
 */
typedef struct rr_served_object rr_served_object;
/** A handle of a service that is offered. It does not keep the service; see rr_service_release. */
typedef struct rr_service rr_service;

/** What is called for an object of a service. Threads of the node. */
typedef struct rr_object_handler {
  size_t size;   /**< sizeof(rr_object_handler), set by the caller */
  void* context; /**< passed to the functions below */
  /** Needed. Properties, functions, objrefs, and peeks of wires where peeks are handled. For each
   * client one at a time, in the order of its requests; of different clients at once. The request
   * belongs to the function. A member that is answered later lets the next request of its client
   * come. */
  void (*on_request)(void* context, rr_request* request, const rr_request_info* info);
  /** The object is reached at a path for the first time: before any request. `service` is the
   * function's own, to be released. Called in rr_service_register for the root. */
  void (*on_attached)(void* context, rr_service* service, rr_str path);
  /** The service has forgotten the object at a path. */
  void (*on_released)(void* context, rr_str path);
  /** The monitor of the object: waits until no other session has it, for wait_ms at most, and
   * returns 1 if it is the caller's now, 0 otherwise. Called on any thread of the node. This and
   * on_monitor_exit: both or none; without them sessions cannot have the object to themselves. */
  int32_t (*on_monitor_enter)(void* context, int32_t wait_ms);
  /** Ends the monitor, perhaps on another thread than on_monitor_enter. */
  void (*on_monitor_exit)(void* context);
  void (*drop)(void* context); /**< last of all, once; see rr.h */
} rr_object_handler;
/** Makes an object with the members of a table. Release it with rr_served_object_release; a service
 * that offers it keeps it. */
RR_API rr_status rr_served_object_new(rr_object_type* type, const rr_object_handler* handler,
                                      rr_served_object** out_object, rr_error** error);
/** Releases the handle. The object lives while a service has it. NULL is allowed. */
RR_API void rr_served_object_release(rr_served_object* object);

/** Answers RR_REQUEST_FIND; the object's handle stays with the caller. With per_client not 0 it is
 * that client's own: each client that follows the objref asks for one, and it is released when the
 * client goes. NULL: there is none, and the client gets RR_SERVICE_ERROR. */
RR_API rr_status rr_request_answer_object(rr_request* request, rr_served_object* object,
                                          int32_t per_client, rr_error** error);

/** What is called for a generator that a service gives. Threads of the node. */
typedef struct rr_generator_handler {
  size_t size;   /**< sizeof(rr_generator_handler), set by the caller */
  void* context; /**< passed to the functions below */
  /** One step at a time. The request's kind is RR_REQUEST_STEP; it belongs to the function. A step
   * that fails ends the generator. */
  void (*on_step)(void* context, rr_request* request, const rr_request_info* info); /**< needed */
  /** The client wants no more steps, or (aborts not 0) breaks off; none follows. Not told when it
   * leaves. */
  void (*on_end)(void* context, int32_t aborts);
  void (*drop)(void* context); /**< last of all, once; see rr.h */
} rr_generator_handler;
/** Answers RR_REQUEST_GENERATOR. */
RR_API rr_status rr_request_answer_generator(rr_request* request,
                                             const rr_generator_handler* handler, rr_error** error);

/* Members of objects. `member` is a place in the table. */

/** Sends an event to all clients of the services that offer the object. */
RR_API rr_status rr_served_event_fire(rr_served_object* object, uint32_t member,
                                      const rr_elements* arguments, rr_error** error);

/** Calls a callback of one client and waits for what it returns: one element, or none for void. May
 * be called in a member that this client has called. */
RR_API rr_status rr_served_callback_call(rr_served_object* object, uint32_t member, uint32_t client,
                                         const rr_elements* arguments,
                                         const rr_call_options* options, rr_data** out_answer,
                                         rr_error** error);
/** Result: rr_data*. */
RR_API rr_status rr_served_callback_call_async(rr_served_object* object, uint32_t member,
                                               uint32_t client, const rr_elements* arguments,
                                               const rr_call_options* options,
                                               const rr_completion* completion, rr_error** error);

/** What is called for a pipe of a served object. Threads of the node. */
typedef struct rr_served_pipe_handler {
  size_t size;   /**< sizeof(rr_served_pipe_handler), set by the caller */
  void* context; /**< passed to the functions below */
  /* A client has connected an endpoint, which belongs to the function. Before the client has its
   * answer. */
  /** A client has connected an endpoint, which belongs to the function. Before the client has its
   * answer. */
  void (*on_connect)(void* context, rr_pipe* pipe);
  void (*drop)(void* context); /**< last of all, once; see rr.h */
} rr_served_pipe_handler;
/** Replaces the handler that was set before. It stays while the object does. */
RR_API rr_status rr_served_pipe_set_handler(rr_served_object* object, uint32_t member,
                                            const rr_served_pipe_handler* handler,
                                            rr_error** error);
/** Sends a packet to all endpoints of all clients. One whose connection takes no more is closed. */
RR_API rr_status rr_served_pipe_send(rr_served_object* object, uint32_t member,
                                     const rr_elements* packet, rr_error** error);
/** In rr_served_pipe_send endpoints with more unacknowledged packets are passed over. 0: none (the
 * default). */
RR_API rr_status rr_served_pipe_set_backlog_limit(rr_served_object* object, uint32_t member,
                                                  size_t packets, rr_error** error);
/** `*count` is the room in `pipes`, and then how many endpoints there are; for as many as fit a
 * handle is stored, which belongs to the caller. */
RR_API rr_status rr_served_pipe_endpoints(rr_served_object* object, uint32_t member,
                                          rr_pipe** pipes, size_t* count, rr_error** error);

/** What is called for a wire of a served object. Threads of the node. */
typedef struct rr_served_wire_handler {
  size_t size;   /**< sizeof(rr_served_wire_handler), set by the caller */
  void* context; /**< passed to the functions below */
  /** A client has connected, and this is its end, which belongs to the function. */
  void (*on_connect)(void* context, rr_wire* wire);
  /** A value that a client has sent or poked. A slow function misses values of the same client. */
  void (*on_value)(void* context, uint32_t client, const rr_elements* value, const rr_time* time,
                   rr_data* data);
  void (*drop)(void* context); /**< last of all, once; see rr.h */
  /** 1: peeks at the service's value come to the object's on_request. Otherwise they are answered
   * with what was sent to all. */
  uint32_t handles_peek_in;
  /** The same for peeks at the newest value of any client. */
  uint32_t handles_peek_out;
} rr_served_wire_handler;
/** To be set once, before clients connect. It stays while the object does. */
RR_API rr_status rr_served_wire_set_handler(rr_served_object* object, uint32_t member,
                                            const rr_served_wire_handler* handler,
                                            rr_error** error);
/** Sends a value to all connected clients, and to each that connects later. */
RR_API rr_status rr_served_wire_send(rr_served_object* object, uint32_t member,
                                     const rr_elements* value, rr_error** error);
/** The newest value from any client. RR_VALUE_NOT_SET for none. */
RR_API rr_status rr_served_wire_received(rr_served_object* object, uint32_t member,
                                         rr_data** out_value, rr_time* out_time, rr_error** error);
/** Values of clients that are older than this, from their arrival, are as none; 0: they never
 * expire. */
RR_API rr_status rr_served_wire_set_lifespan(rr_served_object* object, uint32_t member,
                                             int32_t lifespan_ms, rr_error** error);
/** As rr_served_pipe_endpoints. */
RR_API rr_status rr_served_wire_connections(rr_served_object* object, uint32_t member,
                                            rr_wire** wires, size_t* count, rr_error** error);

/** A memory that a service offers. The functions may be called for several clients at once. A
 * status that is not RR_OK fails the request with that code. */
typedef struct rr_memory_source {
  size_t size;   /**< sizeof(rr_memory_source), set by the caller */
  void* context; /**< passed to the functions below */
  /** Length, or dims: at most `room`, `*count` of them. Needed. */
  rr_status (*dims)(void* context, uint64_t* dims, size_t room, size_t* count);
  /** A part that lies inside, by the dims asked just before. Of numbers: `size` bytes, first
   * dimension fastest. */
  rr_status (*read)(void* context, const uint64_t* position, const uint64_t* count,
                    size_t dim_count, void* items, size_t size);
  /** Takes a part that a client writes: `size` bytes of numbers, first dimension fastest. */
  rr_status (*write)(void* context, const uint64_t* position, const uint64_t* count,
                     size_t dim_count, const void* items, size_t size);
  /** Of pods and namedarrays, instead: the part as the element `data`, an array or a
   * multi-dimensional one. */
  rr_status (*read_piece)(void* context, const uint64_t* position, const uint64_t* count,
                          size_t dim_count, rr_piece* piece);
  /** Takes a part that a client writes, of pods or namedarrays, instead. */
  rr_status (*write_piece)(void* context, const uint64_t* position, const uint64_t* count,
                           size_t dim_count, const rr_elements* data);
  void (*drop)(void* context); /**< last of all, once; see rr.h */
} rr_memory_source;
/** Replaces the source that was set before. */
RR_API rr_status rr_served_memory_set(rr_served_object* object, uint32_t member,
                                      const rr_memory_source* source, rr_error** error);

/* Services. */

/** Who may use services. Counted, as definitions. */
typedef struct rr_users rr_users;
/** Users with passwords, one a line: docs/reference/c-abi.md. RR_INVALID_CONFIGURATION names the
 * line. */
RR_API rr_status rr_users_from_text(rr_str text, rr_users** out_users, rr_error** error);
/** The same, from a file. RR_INVALID_CONFIGURATION when it cannot be read, or for a line that is
 * wrong. */
RR_API rr_status rr_users_from_file(rr_str path, rr_users** out_users, rr_error** error);
/** A function that decides who may log in, instead of a list. */
typedef struct rr_users_handler {
  size_t size;   /**< sizeof(rr_users_handler), set by the caller */
  void* context; /**< passed to the functions below */
  /** The request belongs to the function: rr_request_answer_user, or rr_request_fail with
   * RR_AUTHENTICATION_ERROR. For several clients at once. */
  void (*on_authenticate)(void* context, rr_request* request,
                          const rr_request_info* info); /**< needed */
  void (*drop)(void* context);                          /**< last of all, once; see rr.h */
} rr_users_handler;
/** Users by a function of the program. Release the handle with rr_users_release. */
RR_API rr_status rr_users_new(const rr_users_handler* handler, rr_users** out_users,
                              rr_error** error);
/** Releases this reference; services that use it keep it. NULL is allowed. */
RR_API void rr_users_release(rr_users* users);
/** A hash for a line of such a text, as text. */
RR_API rr_status rr_password_hash(rr_str password, rr_data** out_data, rr_error** error);

/** A client of a service. */
typedef struct rr_client_info {
  size_t size;       /**< sizeof(rr_client_info), set by the caller */
  uint32_t client;   /**< its endpoint's number in this node */
  uint32_t reserved; /**< 0 */
  rr_node_id node;   /**< as it says of itself, or as its certificate proves */
  rr_str node_name;  /**< as it says; empty for none */
  rr_str user;       /**< the user that is logged in; empty for none, and in on_client_... */
  uint64_t session;  /**< no other session of this process has had this number (minor version 2) */
} rr_client_info;

/** How a service is offered. All zero but the size: the defaults. */
typedef struct rr_service_options {
  size_t size;            /**< sizeof(rr_service_options), set by the caller */
  rr_elements attributes; /**< one element, a map of strings to varvalues; count 0 for none */
  rr_definition* const* extra_definitions; /**< whose types may be in varvalues and varobjects */
  size_t extra_definition_count;           /**< of `extra_definitions` */
  const rr_users* users;                   /**< NULL: every client, and no object can be locked */
  uint32_t user_is_optional;               /**< with users: 1 lets clients connect without one */
  int32_t monitor_patience_ms;             /**< 0: 30 s */
  void* context;                           /**< passed to the functions below */
  /** On a thread of the node, before the first request of the client. */
  void (*on_client_connected)(void* context, const rr_client_info* client);
  /** On a thread of the node, after the last request of the client. */
  void (*on_client_disconnected)(void* context, const rr_client_info* client);
  void (*drop)(void* context); /**< behind the end of the service */
  /** Once, as soon as no client waits for answers of a session any more: its client has left or is
   * lost, or the service was closed. What it has asked for may still be handled, and is to be
   * broken off. On a thread of the node or that of rr_service_close or _disconnect, before
   * on_client_disconnected (minor version 2). */
  void (*on_client_leaving)(void* context, const rr_client_info* client);
  /** What each user may do, as docs/howto/access.md has it (minor version 4, as the next). NULL:
   * everything; a text without rules allows nothing. */
  const rr_str* rights;
  /** The same in a file, instead of `rights`; empty: none. It is looked at every second. */
  rr_str rights_file;
} rr_service_options;

/** Offers an object and what it refers to, until the service is closed or the node ends.
 * `out_service` may be NULL. */
RR_API rr_status rr_service_register(rr_node* node, rr_str name, rr_served_object* root,
                                     const rr_service_options* options, rr_service** out_service,
                                     rr_error** error);
/** Lets go of the handle; the service goes on. A handle does not keep a service either: when that
 * has ended, what is asked of it fails with RR_INVALID_OPERATION, or does nothing. */
RR_API void rr_service_release(rr_service* service);
/** Tells all clients that the service is closed, and ends their sessions. The name is free again.
 */
RR_API void rr_service_close(rr_service* service);
/** Valid while the handle is. */
RR_API rr_str rr_service_name(const rr_service* service);
/** Other attributes from now on: a map of strings to varvalues. Clients get them when they connect
 * or ask. */
RR_API rr_status rr_service_set_attributes(rr_service* service, const rr_elements* attributes,
                                           rr_error** error);
/** Other rights from now on, for sessions that are open, too: what they may not do any more ends.
 * NULL: everything. They hold until the file of rights changes, if there is one (minor version 4).
 */
RR_API rr_status rr_service_set_rights(rr_service* service, const rr_str* rights, rr_error** error);
/** Forgets the object at a path and those below, and tells the clients; the next request finds it
 * anew. With a client that is not 0: only that client's own object. */
RR_API rr_status rr_service_release_path(rr_service* service, rr_str path, uint32_t client,
                                         rr_error** error);
/** Calls the function for each client that is connected now, in the thread of the caller. */
RR_API rr_status rr_service_clients(const rr_service* service, void* context,
                                    void (*each)(void* context, const rr_client_info* client),
                                    rr_error** error);
/** Ends the session of a client, if it has one. */
RR_API void rr_service_disconnect(rr_service* service, uint32_t client);

/** The client whose request this thread handles; 0 outside of that. */
RR_API uint32_t rr_current_client(void);
/** The user that is logged in there, as text; NULL for none. */
RR_API rr_status rr_current_user(rr_data** out_name, rr_error** error);
/** 1 when that user has a privilege. */
RR_API int32_t rr_current_user_has(rr_str privilege);

#ifdef __cplusplus
}
#endif

#endif
