/* SPDX-License-Identifier: Apache-2.0 */
#ifndef RR_C_CLIENT_H
#define RR_C_CLIENT_H

/** @file
 * The client's side of a service: sessions, objects, properties, functions, events, callbacks,
 * generators, memories. Included by rr.h. Blocking calls send in the thread of the caller, which
 * reads the connection itself until its answer is there; they may be made anywhere, in functions
 * that the runtime calls too. */

#include "node.h"

#ifdef __cplusplus
extern "C" {
#endif

/** An object of a service, named by its path. Keeps its session, but does not hold the connection
 * open. With the last handle of an object at a path end its event handlers and callbacks; those of
 * the root object also need the client's handle to go. */
typedef struct rr_object rr_object;

/* Sessions. */

/** Closes the session, as rr_client_close, and lets go of it. */
RR_API void rr_client_release(rr_client* client);
/** Tells the service, waits for its answer for half a second at most, and ends the connection. Open
 * calls fail with RR_CONNECTION_ERROR. Nothing happens the second time. */
RR_API void rr_client_close(rr_client* client);
/** 0 once either side has ended the session. */
RR_API int32_t rr_client_is_open(const rr_client* client);
/** Ends all open calls with RR_OPERATION_CANCELLED. */
RR_API void rr_client_cancel_calls(rr_client* client);
/** The version of the format in which this connection speaks: 2 or 4. */
RR_API uint32_t rr_client_message_version(const rr_client* client);
/** The id of the node that offers the service. All zero for a NULL handle. */
RR_API rr_node_id rr_client_remote_node(const rr_client* client);
/** The name of that node, empty for none. Valid while the client is. */
RR_API rr_str rr_client_remote_name(const rr_client* client);
/** The type of the root object, qualified, as the service told it. Valid while the client is. */
RR_API rr_str rr_client_object_type(const rr_client* client);
/** The root object, with a handle of its own: release it with rr_object_release. */
RR_API rr_status rr_client_root(rr_client* client, rr_object** out_object, rr_error** error);
/** Texts of the service's definitions, as many as have come: one element each, a string named after
 * its definition. Version 4. */
RR_API rr_status rr_client_definitions(const rr_client* client, rr_data** out_data,
                                       rr_error** error);
/** What the service said about itself in connecting: one element, a map of strings to varvalues.
 * Version 4. */
RR_API rr_status rr_client_attributes(const rr_client* client, rr_data** out_data,
                                      rr_error** error);
/** The same, asked for now: a request to the service. */
RR_API rr_status rr_client_fetch_attributes(rr_client* client, rr_data** out_data,
                                            rr_error** error);
/** Logs in, perhaps as another user than in connecting. `credentials`: as in rr_connect_options. */
RR_API rr_status rr_client_authenticate(rr_client* client, rr_str username, rr_str password,
                                        const rr_elements* credentials, rr_error** error);
/** Logs out: the session goes on without a user, where the service allows that. */
RR_API rr_status rr_client_logout(rr_client* client, rr_error** error);

/* Objects. */

/** Releases the handle. With the object's last one its event handlers and callbacks end. */
RR_API void rr_object_release(rr_object* object);
/** Valid while the object's handle is. */
RR_API rr_str rr_object_path(const rr_object* object);
/** As the service told it, qualified. */
RR_API rr_str rr_object_type_name(const rr_object* object);
/** 1 when that is, or implements, directly or not, `type`, as far as definitions have come. */
RR_API int32_t rr_object_is_a(const rr_object* object, rr_str type);

/** How an rr_index is written: RR_INDEX_NONE for an objref without one, RR_INDEX_INT32 for a
 * number, RR_INDEX_STRING for a text. */
enum { RR_INDEX_NONE = 0, RR_INDEX_INT32 = 1, RR_INDEX_STRING = 2 };
/** The index of an objref. */
typedef struct rr_index {
  uint32_t form;  /**< RR_INDEX_... */
  int32_t number; /**< of RR_INDEX_INT32 */
  rr_str text;    /**< as it is, not escaped */
} rr_index;
/** The object at an objref. `index` may be NULL for none; `type` is what it must be or implement,
 * empty for anything. The service is asked, unless there is a handle of the object already. */
RR_API rr_status rr_object_find(rr_object* object, rr_str member, const rr_index* index,
                                rr_str type, const rr_call_options* options, rr_object** out_object,
                                rr_error** error);
/** Result: rr_object*. */
RR_API rr_status rr_object_find_async(rr_object* object, rr_str member, const rr_index* index,
                                      rr_str type, const rr_call_options* options,
                                      const rr_completion* completion, rr_error** error);
/** The type of what is at an objref now, as text. */
RR_API rr_status rr_object_find_type(rr_object* object, rr_str member, const rr_index* index,
                                     const rr_call_options* options, rr_data** out_data,
                                     rr_error** error);

/** Requests, by the protocol's numbers. Others are refused. */
enum {
  RR_PROPERTY_GET = 1111,  /**< no element; answer: `value` */
  RR_PROPERTY_SET = 1113,  /**< `value`; answer: no element */
  RR_FUNCTION_CALL = 1121, /**< the arguments; answer: `return` */
  RR_MEMORY_READ =
      1171, /**< the requests of one memory transfer, which rr_memory_... makes of numbers */
  /** position, count and items of a part; answer: position and count */
  RR_MEMORY_WRITE = 1173,
  RR_MEMORY_GET_PARAM = 1175 /**< the name of a parameter of the memory; answer: its value */
};
/** Sends a request to a member and waits for the answer, whose elements are in `*out_answer`: of a
 * function without a value one that means nothing. `elements` may be NULL for none. */
RR_API rr_status rr_object_call(rr_object* object, uint32_t request, rr_str member,
                                const rr_elements* elements, const rr_call_options* options,
                                rr_data** out_answer, rr_error** error);
/** The same without waiting: the elements are sent, or copied, before it returns. Result: rr_data*.
 */
RR_API rr_status rr_object_call_async(rr_object* object, uint32_t request, rr_str member,
                                      const rr_elements* elements, const rr_call_options* options,
                                      const rr_completion* completion, rr_error** error);

/** Locks (07, section 6): for all sessions of the user, or with session_only not 0 for this one. */
RR_API rr_status rr_object_lock(rr_object* object, int32_t session_only,
                                const rr_call_options* options, rr_error** error);
/** Ends this user's lock, or with the privilege `objectlockoverride` another user's. */
RR_API rr_status rr_object_unlock(rr_object* object, const rr_call_options* options,
                                  rr_error** error);
/** Waits until this session alone may use the object; wait_ms: RR_NO_LIMIT for as long as it takes.
 */
RR_API rr_status rr_object_enter_monitor(rr_object* object, int32_t wait_ms,
                                         const rr_call_options* options, rr_error** error);
/** Ends the monitor that this session has entered. Services may say nothing when it has entered
 * none. */
RR_API rr_status rr_object_exit_monitor(rr_object* object, const rr_call_options* options,
                                        rr_error** error);

/* Events. */

/** What is called for an event. Threads of the node. */
typedef struct rr_event_handler {
  size_t size;   /**< sizeof(rr_event_handler), set by the caller */
  void* context; /**< passed to the functions below */
  /** For each event, in order, one at a time for each session. `data` holds the arguments, and may
   * be retained. */
  void (*on_event)(void* context, const rr_elements* arguments, rr_data* data); /**< needed */
  void (*drop)(void* context); /**< last of all, once; see rr.h */
} rr_event_handler;
/** Does not ask the service: it sends its events to every client. The subscription ends with its
 * release, with the session, or with the object's last handle. */
RR_API rr_status rr_event_subscribe(rr_object* object, rr_str member,
                                    const rr_event_handler* handler,
                                    rr_subscription** out_subscription, rr_error** error);

/* Callbacks. */

/** The function of the client that a service may call. Threads of the node. */
typedef struct rr_callback_handler {
  size_t size;   /**< sizeof(rr_callback_handler), set by the caller */
  void* context; /**< passed to the functions below */
  /** Several may run at once. The request's kind is RR_REQUEST_CALLBACK, and it belongs to the
   * function. */
  void (*on_call)(void* context, rr_request* request); /**< needed */
  void (*drop)(void* context);                         /**< last of all, once; see rr.h */
} rr_callback_handler;
/** From now on the service gets this function, until it is cleared, another one is set, the session
 * ends or the object's last handle goes. `returns_value` is 0 for void. */
RR_API rr_status rr_callback_set(rr_object* object, rr_str member, uint32_t access,
                                 int32_t returns_value, const rr_callback_handler* handler,
                                 rr_error** error);
/** Waits for calls that run, unless one of them is the caller. */
RR_API rr_status rr_callback_clear(rr_object* object, rr_str member, rr_error** error);

/* Generators. */

/** Steps may be made from any thread; the service takes them one after the other. Released before
 * its end it is closed, without waiting. */
typedef struct rr_generator rr_generator;
/** Calls the function and gives its generator, before the first step. Release it with
 * rr_generator_release. */
RR_API rr_status rr_generator_open(rr_object* object, rr_str member, const rr_elements* arguments,
                                   const rr_call_options* options, rr_generator** out_generator,
                                   rr_error** error);
/** Result: rr_generator*. */
RR_API rr_status rr_generator_open_async(rr_object* object, rr_str member,
                                         const rr_elements* arguments,
                                         const rr_call_options* options,
                                         const rr_completion* completion, rr_error** error);
/** One step. `parameter` is NULL where none is taken. At the end RR_STOP_ITERATION is returned,
 * without an error. Otherwise `*out_value` holds one element: the value, or where none is given
 * what void looks like, which means nothing. */
RR_API rr_status rr_generator_next(rr_generator* generator, const rr_elements* parameter,
                                   const rr_call_options* options, rr_data** out_value,
                                   rr_error** error);
/** Result: rr_data*, NULL without an error at the end. */
RR_API rr_status rr_generator_next_async(rr_generator* generator, const rr_elements* parameter,
                                         const rr_call_options* options,
                                         const rr_completion* completion, rr_error** error);
/** No more steps are wanted, or (aborts not 0) the service is to break off. */
RR_API rr_status rr_generator_end(rr_generator* generator, int32_t aborts,
                                  const rr_call_options* options, rr_error** error);
/** Result: NULL. */
RR_API rr_status rr_generator_end_async(rr_generator* generator, int32_t aborts,
                                        const rr_call_options* options,
                                        const rr_completion* completion, rr_error** error);
/** Releases the handle; a generator that has not come to its end is closed, without waiting. NULL
 * is allowed. */
RR_API void rr_generator_release(rr_generator* generator);

/* Memories. Positions and counts are in items, one for each dimension. */

/** What a memory is of, on both sides. */
typedef struct rr_memory_type {
  uint32_t element; /**< type of an item: the protocol's number of double (1) ... bool (14, a byte);
                       110  for pods, 115 for namedarrays, which are transferred as elements */
  uint32_t is_multi;      /**< 0: T[], 1: T[*] */
  uint32_t access;        /**< modifiers */
  uint32_t transfer_size; /**< of pods and namedarrays: bytes that an item counts for against the
                             limit of a request: the most that a pod takes in format 2, one number
                             of a namedarray */
} rr_memory_type;

/** The length of a memory T[], in items. */
RR_API rr_status rr_memory_length(rr_object* object, rr_str member, const rr_call_options* options,
                                  uint64_t* out_length, rr_error** error);
/** The dims of a memory T[*]: `*dim_count` is the room in `dims`, and then how many there are, of
 * which those are stored for which there is room. */
RR_API rr_status rr_memory_dims(rr_object* object, rr_str member, const rr_call_options* options,
                                uint64_t* dims, size_t* dim_count, rr_error** error);
/** Transfers a part of a memory of numbers, in as many requests as the limits of both sides want,
 * the time-out being for each. `items` are size bytes, exactly as many as the part has, first
 * dimension fastest. */
RR_API rr_status rr_memory_read(rr_object* object, rr_str member, const rr_memory_type* type,
                                const uint64_t* position, const uint64_t* count, size_t dim_count,
                                void* items, size_t size, const rr_call_options* options,
                                rr_error** error);
/** The same the other way: sends `items` to that part of the memory. It stops at the first request
 * that fails; what was written before stays. */
RR_API rr_status rr_memory_write(rr_object* object, rr_str member, const rr_memory_type* type,
                                 const uint64_t* position, const uint64_t* count, size_t dim_count,
                                 const void* items, size_t size, const rr_call_options* options,
                                 rr_error** error);
/** rr_memory_read without waiting. `items` stay where they are until the completion is called.
 * Result: NULL. */
RR_API rr_status rr_memory_read_async(rr_object* object, rr_str member, const rr_memory_type* type,
                                      const uint64_t* position, const uint64_t* count,
                                      size_t dim_count, void* items, size_t size,
                                      const rr_call_options* options,
                                      const rr_completion* completion, rr_error** error);
/** rr_memory_write without waiting. `items` stay where they are, unchanged, until the completion is
 * called. Result: NULL. */
RR_API rr_status rr_memory_write_async(rr_object* object, rr_str member, const rr_memory_type* type,
                                       const uint64_t* position, const uint64_t* count,
                                       size_t dim_count, const void* items, size_t size,
                                       const rr_call_options* options,
                                       const rr_completion* completion, rr_error** error);

/** A piece that a function is asked for: filled with rr_piece_set, valid during that call. */
typedef struct rr_piece rr_piece;
/** How a transfer of pods or namedarrays hands over its pieces. The part is cut by the same rules
 * as one of numbers, and each piece handed over as the element `data`: an array, or with is_multi
 * a multi-dimensional array. The functions end the transfer by anything but RR_OK, which is then
 * what fails. `offset` is where the piece's first item is among those of the part. */
typedef struct rr_memory_pieces {
  size_t size;   /**< sizeof(rr_memory_pieces), set by the caller */
  void* context; /**< passed to the functions below */
  /** Needed to read: takes a piece that has come. */
  rr_status (*take)(void* context, uint64_t offset, const uint64_t* count, size_t dim_count,
                    const rr_elements* data); /**< of a read */
  /** Needed to write: gives the next piece, with rr_piece_set. */
  rr_status (*give)(void* context, uint64_t offset, const uint64_t* count, size_t dim_count,
                    rr_piece* piece); /**< of a write */
} rr_memory_pieces;
/** Gives the piece its items: the element `data`. It is copied. */
RR_API rr_status rr_piece_set(rr_piece* piece, const rr_elements* data, rr_error** error);
/** Reads a part of a memory of pods or namedarrays. Blocking; the functions are called in the
 * thread of the caller. */
RR_API rr_status rr_memory_read_pieces(rr_object* object, rr_str member, const rr_memory_type* type,
                                       const uint64_t* position, const uint64_t* count,
                                       size_t dim_count, const rr_memory_pieces* pieces,
                                       const rr_call_options* options, rr_error** error);
/** Writes a part of a memory of pods or namedarrays. Blocking; the functions are called in the
 * thread of the caller. */
RR_API rr_status rr_memory_write_pieces(rr_object* object, rr_str member,
                                        const rr_memory_type* type, const uint64_t* position,
                                        const uint64_t* count, size_t dim_count,
                                        const rr_memory_pieces* pieces,
                                        const rr_call_options* options, rr_error** error);

/** rr_memory_read_pieces without waiting (minor version 1): the functions are called on threads of
 * the node, one at a time, and not any more once the completion is. `pieces` is read during the
 * call only. Result: NULL. */
RR_API rr_status rr_memory_read_pieces_async(rr_object* object, rr_str member,
                                             const rr_memory_type* type, const uint64_t* position,
                                             const uint64_t* count, size_t dim_count,
                                             const rr_memory_pieces* pieces,
                                             const rr_call_options* options,
                                             const rr_completion* completion, rr_error** error);
/** rr_memory_write_pieces without waiting, likewise (minor version 1). Result: NULL. */
RR_API rr_status rr_memory_write_pieces_async(rr_object* object, rr_str member,
                                              const rr_memory_type* type, const uint64_t* position,
                                              const uint64_t* count, size_t dim_count,
                                              const rr_memory_pieces* pieces,
                                              const rr_call_options* options,
                                              const rr_completion* completion, rr_error** error);

#ifdef __cplusplus
}
#endif

#endif
