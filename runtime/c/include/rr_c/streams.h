/* SPDX-License-Identifier: Apache-2.0 */
#ifndef RR_C_STREAMS_H
#define RR_C_STREAMS_H

/** @file
 * Pipes and wires: the client's members, and the ends that both sides have. Included by rr.h. */

#include "client.h"

#ifdef __cplusplus
extern "C" {
#endif

/** One end of a connected pipe. It stays connected until it is closed, its session ends or its
 * object is released, whether or not a handle is held. Packets that have come can be
 * received from a closed end too. */
typedef struct rr_pipe rr_pipe;

/** How a pipe is connected. All zero but the size: the defaults. */
typedef struct rr_pipe_options {
  size_t size;       /**< sizeof(rr_pipe_options), set by the caller */
  uint32_t access;   /**< modifiers: RR_READONLY, RR_WRITEONLY and RR_UNRELIABLE count */
  int32_t index;     /**< wanted; the service decides. -1 leaves it to it, 0 asks for 0 */
  uint32_t reliable; /**< 1: although the pipe is declared unreliable */
  uint32_t reserved; /**< 0 */
} rr_pipe_options;

/** Connects an endpoint of a pipe and waits for the answer. `pipe_options` may be NULL. */
RR_API rr_status rr_pipe_connect(rr_object* object, rr_str member,
                                 const rr_pipe_options* pipe_options,
                                 const rr_call_options* options, rr_pipe** out_pipe,
                                 rr_error** error);
/** Result: rr_pipe*. */
RR_API rr_status rr_pipe_connect_async(rr_object* object, rr_str member,
                                       const rr_pipe_options* pipe_options,
                                       const rr_call_options* options,
                                       const rr_completion* completion, rr_error** error);
/** Releases the handle; the endpoint stays connected. NULL is allowed. */
RR_API void rr_pipe_release(rr_pipe* pipe);
/** Disconnects. A client waits for the service's answer for half a second at most. */
RR_API void rr_pipe_close(rr_pipe* pipe);
/** 1 until the endpoint is closed, by either side, or lost. */
RR_API int32_t rr_pipe_is_open(const rr_pipe* pipe);
/** The number of the endpoint among those of its pipe and client. -1 for a NULL handle. */
RR_API int32_t rr_pipe_index(const rr_pipe* pipe);
/** Both sides have agreed that packets may be lost or come in another order. */
RR_API int32_t rr_pipe_is_unreliable(const rr_pipe* pipe);
/** On the service's side: the client. 0 on the client's side. */
RR_API uint32_t rr_pipe_client(const rr_pipe* pipe);

/** Sends a packet, and stores its number: 1, 2, ... Never waits: RR_BUFFER_LIMIT_VIOLATION when the
 * connection takes no more. `out_number` may be NULL. */
RR_API rr_status rr_pipe_send(rr_pipe* pipe, const rr_elements* packet, uint32_t* out_number,
                              rr_error** error);
/** Waits until at most so many bytes of the connection wait to be sent. 0 when the time was over,
 * or the end closed, before. */
RR_API int32_t rr_pipe_wait_sent(const rr_pipe* pipe, int32_t timeout_ms, size_t bytes);
/** The packet that has waited longest, or NULL for none. */
RR_API rr_status rr_pipe_receive(rr_pipe* pipe, rr_data** out_packet, rr_error** error);
/** The same, which stays. */
RR_API rr_status rr_pipe_peek(const rr_pipe* pipe, rr_data** out_packet, rr_error** error);
/** Waits until a packet is there. 0 when the time was over, or the end closed, before. */
RR_API int32_t rr_pipe_wait(const rr_pipe* pipe, int32_t timeout_ms);
/** Ends with the next packet, or RR_INVALID_OPERATION when the end is closed before one comes.
 * Result: rr_data*. */
RR_API rr_status rr_pipe_receive_async(rr_pipe* pipe, const rr_completion* completion,
                                       rr_error** error);
/** The same, until options->cancellation ends it with RR_OPERATION_CANCELLED, or a time-out with
 * RR_REQUEST_TIMEOUT: then no packet is taken. Without a time-out it waits for ever. `options` may
 * be NULL. Minor version 2. */
RR_API rr_status rr_pipe_receive_within_async(rr_pipe* pipe, const rr_call_options* options,
                                              const rr_completion* completion, rr_error** error);
/** Packets that have come and wait to be received. */
RR_API size_t rr_pipe_available(const rr_pipe* pipe);

/** What gives way when a queue is full: RR_DROP_OLDEST and RR_DROP_NEWEST lose a packet, RR_CLOSE
 * closes the endpoint. */
enum { RR_DROP_OLDEST = 0, RR_DROP_NEWEST = 1, RR_CLOSE = 2 };
/** At most so many packets, and bytes of them as they have travelled, wait to be received, but
 * always one (65,536, 64 MiB, RR_CLOSE). 0 bytes: 64 MiB. */
RR_API rr_status rr_pipe_set_queue_limit(rr_pipe* pipe, size_t packets, size_t bytes,
                                         uint32_t when_full, rr_error** error);
/** Packets that were lost because the queue was full. */
RR_API size_t rr_pipe_lost_count(const rr_pipe* pipe);
/** Whether packets that are sent are acknowledged. Off at first. */
RR_API void rr_pipe_ask_for_acknowledgements(rr_pipe* pipe, int32_t on);
/** Packets that are still on their way, while they are acknowledged. */
RR_API size_t rr_pipe_unacknowledged(const rr_pipe* pipe);

/** What is called for an endpoint of a pipe. Threads of the node. */
typedef struct rr_pipe_handler {
  size_t size;   /**< sizeof(rr_pipe_handler), set by the caller */
  void* context; /**< passed to the functions below */
  /** Packets that wait, and those that come, in order, one at a time, instead of being kept. NULL:
   * they are kept. `data` holds the packet, and may be retained. */
  void (*on_packet)(void* context, const rr_elements* packet, rr_data* data);
  /** The other side has received the packet of this number. Only while acknowledgements are asked
   * for. */
  void (*on_acknowledged)(void* context, uint32_t number);
  /** Once, behind the packets; at once if it is closed already. */
  void (*on_closed)(void* context);
  void (*drop)(void* context); /**< last of all, once; see rr.h */
} rr_pipe_handler;
/** Replaces the functions that were set before. They stay while the end is connected, even without
 * a handle of it. With a NULL handler: there are none any more, and packets are kept again. Waits
 * for an on_packet of the handler before, unless it is the caller. */
RR_API rr_status rr_pipe_set_handler(rr_pipe* pipe, const rr_pipe_handler* handler,
                                     rr_error** error);

/** One end of a connected wire: as that of a pipe. Of its values only the newest counts. What a
 * client receives is "in", and what it sends "out"; a service sends "in" and receives "out". */
typedef struct rr_wire rr_wire;

/** RR_INVALID_OPERATION when the client has connected it already. `access`: RR_READONLY,
 * RR_WRITEONLY. */
RR_API rr_status rr_wire_connect(rr_object* object, rr_str member, uint32_t access,
                                 const rr_call_options* options, rr_wire** out_wire,
                                 rr_error** error);
/** Result: rr_wire*. */
RR_API rr_status rr_wire_connect_async(rr_object* object, rr_str member, uint32_t access,
                                       const rr_call_options* options,
                                       const rr_completion* completion, rr_error** error);
/** Releases the handle; the wire stays connected. NULL is allowed. */
RR_API void rr_wire_release(rr_wire* wire);
/** Disconnects. A client waits for the service's answer for half a second at most. */
RR_API void rr_wire_close(rr_wire* wire);
/** 1 until the end is closed, by either side, or lost. */
RR_API int32_t rr_wire_is_open(const rr_wire* wire);
/** On the service's side: the client. 0 on the client's side. */
RR_API uint32_t rr_wire_client(const rr_wire* wire);

/** Sends a value; never waits. */
RR_API rr_status rr_wire_send(rr_wire* wire, const rr_elements* value, rr_error** error);
/** The newest value that has come and has not expired, and when it was sent. RR_VALUE_NOT_SET for
 * none. `out_time` may be NULL, here and below. */
RR_API rr_status rr_wire_received(const rr_wire* wire, rr_data** out_value, rr_time* out_time,
                                  rr_error** error);
/** What was sent last. RR_VALUE_NOT_SET for nothing yet. */
RR_API rr_status rr_wire_sent(const rr_wire* wire, rr_data** out_value, rr_time* out_time,
                              rr_error** error);
/** Waits until there is a value. 0 when the time was over, or the end closed, before. May be called
 * anywhere: values come while functions of the program run. */
RR_API int32_t rr_wire_wait(const rr_wire* wire, int32_t timeout_ms);
/** A value older than this, from its arrival, is as none; 0: never. */
RR_API void rr_wire_set_lifespan(rr_wire* wire, int32_t lifespan_ms);

/** What is called for an end of a wire. Threads of the node. */
typedef struct rr_wire_handler {
  size_t size;   /**< sizeof(rr_wire_handler), set by the caller */
  void* context; /**< passed to the functions below */
  /** The value that is there, and those that come, in order, one at a time; a slow function misses
   * values, never the newest. `data` holds it, and may be retained. */
  void (*on_value)(void* context, const rr_elements* value, const rr_time* time, rr_data* data);
  /** Once; at once if it is closed already. */
  void (*on_closed)(void* context);
  void (*drop)(void* context); /**< last of all, once; see rr.h */
} rr_wire_handler;
/** As rr_pipe_set_handler. */
RR_API rr_status rr_wire_set_handler(rr_wire* wire, const rr_wire_handler* handler,
                                     rr_error** error);

/** Asks for the service's value now, without a connection: a request. `out_time`, when it was sent,
 * may be NULL. RR_VALUE_NOT_SET for none. */
RR_API rr_status rr_wire_peek_in(rr_object* object, rr_str member, const rr_call_options* options,
                                 rr_data** out_value, rr_time* out_time, rr_error** error);
/** Asks for the value that the service has last received from a client. RR_VALUE_NOT_SET for none.
 */
RR_API rr_status rr_wire_peek_out(rr_object* object, rr_str member, const rr_call_options* options,
                                  rr_data** out_value, rr_time* out_time, rr_error** error);
/** Gives the service a value, without a connection: a request. */
RR_API rr_status rr_wire_poke_out(rr_object* object, rr_str member, const rr_elements* value,
                                  const rr_call_options* options, rr_error** error);
/** rr_wire_peek_in without waiting. Result: rr_data*. `out_time` is written before the completion
 * is called, until when it must stay. */
RR_API rr_status rr_wire_peek_in_async(rr_object* object, rr_str member,
                                       const rr_call_options* options, rr_time* out_time,
                                       const rr_completion* completion, rr_error** error);
/** rr_wire_peek_out without waiting, likewise. Result: rr_data*. */
RR_API rr_status rr_wire_peek_out_async(rr_object* object, rr_str member,
                                        const rr_call_options* options, rr_time* out_time,
                                        const rr_completion* completion, rr_error** error);
/** rr_wire_poke_out without waiting. Result: NULL. */
RR_API rr_status rr_wire_poke_out_async(rr_object* object, rr_str member, const rr_elements* value,
                                        const rr_call_options* options,
                                        const rr_completion* completion, rr_error** error);

#ifdef __cplusplus
}
#endif

#endif
