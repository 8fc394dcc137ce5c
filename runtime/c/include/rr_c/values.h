/* SPDX-License-Identifier: Apache-2.0 */
#ifndef RR_C_VALUES_H
#define RR_C_VALUES_H

/** @file
 * Versions, texts, elements, errors, and what is told about one call. Included by rr.h. */

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__) && !defined(_WIN32)
/** Marks what the library exports. */
#define RR_API __attribute__((visibility("default")))
#else
/** Marks what the library exports. On Windows the library has a list of it. */
#define RR_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** Major part in the upper 16 bits, minor in the lower. A program refuses another major version
 * than that of the header it was made with, and a lower minor one. Minor versions add functions,
 * and fields at the end of structs that have a size. */
#define RR_ABI_VERSION 0x00010005u

/** The version of the library that is loaded. To be called first. */
RR_API uint32_t rr_abi_version(void);

/** UTF-8 without a NUL at the end. `data` may be NULL when the size is 0. */
typedef struct rr_str {
  const char* data; /**< may be NULL when the size is 0 */
  size_t size;      /**< bytes */
} rr_str;

/** Seconds since 1970-01-01 UTC; 0 <= nanoseconds < 1e9. */
typedef struct rr_time {
  int64_t seconds;     /**< since 1970-01-01 UTC; negative before it */
  int32_t nanoseconds; /**< 0 to 999,999,999 */
  int32_t reserved;    /**< 0 */
} rr_time;

/** 16 bytes in the order of the text. All zero: none. */
typedef struct rr_node_id {
  uint8_t bytes[16]; /**< as the hexadecimal digits of the id's text stand */
} rr_node_id;

/** Some elements back to back, as they lie in a message of a version of the format (2 or 4;
 * specification 01 section 5, 02 section 4). Arguments of a function are as many elements as it has
 * parameters, named after them; a single value is one element.
 *
 * What the runtime hands out has been checked: all lengths lie inside, and strings are spelled out
 * (no codes of a string table). It is in the version in which it came. Payloads of at least 16 KiB
 * are aligned for their items where they lie in a large message.
 *
 * What the program hands in may be in either version, and is rewritten when the connection speaks
 * the other; rr_client_message_version and rr_request_info tell which one costs nothing. It is
 * checked, which fails with RR_DATA_SERIALIZATION_ERROR, and read during the call only. The name of
 * a single value does not matter, it is replaced by the one that the protocol wants.
 *
 * Large arrays that the program hands in may stay where they are (minor version 1): `version` then
 * has RR_WITH_REFERENCES added, and an element at any depth that is one rr_array_reference, bytes
 * (uint8, 4) with the metadata RR_REFERENCE, stands for an element of the same name that holds
 * these items. They are sent from there, and copied only where the call says that it copies.
 */
typedef struct rr_elements {
  const uint8_t* data; /**< the first element's first byte */
  size_t size;         /**< bytes of all elements */
  uint32_t count;      /**< of elements */
  uint32_t version;    /**< of the format: 2 or 4, and RR_WITH_REFERENCES */
} rr_elements;

/** RR_WITH_REFERENCES is added to the version of rr_elements some of which are an
 * rr_array_reference instead of a value (minor version 1). */
enum { RR_WITH_REFERENCES = 0x100 };
/** The metadata of an element that is an rr_array_reference. */
#define RR_REFERENCE "rr.array"
/** In the order of the machine, at any alignment. */
typedef struct rr_array_reference {
  const void* items; /**< stay where they are until the call returns, or longer where it says so */
  uint64_t count;    /**< of items */
  uint32_t type;     /**< the protocol's number of a packed type: double (1) ... bool (14) */
  uint32_t reserved; /**< 0 */
} rr_array_reference;

/** Received bytes. They stay where they are until the last reference is released: no copy is
 * needed. */
typedef struct rr_data rr_data;
/** The elements in it. For what is text or bytes: one element with count 0 and version 0. */
RR_API rr_elements rr_data_elements(const rr_data* data);
/** Another reference to the same; returns `data`. */
RR_API rr_data* rr_data_retain(rr_data* data);
/** Releases a reference. The bytes end with the last one; NULL is allowed. */
RR_API void rr_data_release(rr_data* data);

/** RR_OK, or the code of an error: one of the protocol's numbers below. */
typedef int32_t rr_status;

/** Codes of the protocol (07, section 14). */
enum {
  RR_OK = 0,                /**< done, no error */
  RR_CONNECTION_ERROR = 1,  /**< there is no connection, or it was lost */
  RR_PROTOCOL_ERROR = 2,    /**< the other side has broken the rules of the protocol */
  RR_SERVICE_NOT_FOUND = 3, /**< there is no service of this name */
  RR_OBJECT_NOT_FOUND = 4,  /**< there is no object at this path */
  RR_INVALID_ENDPOINT = 5,  /**< the session is not, or no longer, there */
  RR_ENDPOINT_COMMUNICATION_FATAL_ERROR = 6, /**< the session cannot go on */
  RR_NODE_NOT_FOUND = 7,            /**< there is no node of this id or name at the address */
  RR_SERVICE_ERROR = 8,             /**< the service does not do what was asked for */
  RR_MEMBER_NOT_FOUND = 9,          /**< the object has no such member */
  RR_MEMBER_FORMAT_MISMATCH = 10,   /**< the member exists, and is of another kind */
  RR_DATA_TYPE_MISMATCH = 11,       /**< a value of another type than declared */
  RR_DATA_TYPE_ERROR = 12,          /**< a value that is no value of its type: length, dims, keys */
  RR_DATA_SERIALIZATION_ERROR = 13, /**< bytes that are no elements */
  RR_MESSAGE_ENTRY_NOT_FOUND = 14,  /**< a message without an entry that it must have */
  RR_MESSAGE_ELEMENT_NOT_FOUND = 15, /**< an argument, a field or a part of a value is missing */
  RR_UNKNOWN_ERROR = 16,             /**< an error without a code of its own; its name says more */
  RR_INVALID_OPERATION = 17,         /**< not in this state, or not twice */
  RR_INVALID_ARGUMENT = 18,          /**< an argument that makes no sense */
  RR_OPERATION_FAILED = 19,          /**< tried, and failed */
  RR_NULL_VALUE = 20,                /**< null where a value must be */
  RR_INTERNAL_ERROR = 21,            /**< a mistake in the runtime */
  RR_SYSTEM_RESOURCE_PERMISSION_DENIED = 22, /**< the system does not allow it */
  RR_OUT_OF_SYSTEM_RESOURCE = 23,            /**< no memory, threads or descriptors left */
  RR_SYSTEM_RESOURCE_ERROR = 24,             /**< the system has refused */
  RR_RESOURCE_NOT_FOUND = 25,     /**< a file or another thing of the system is not there */
  RR_IO_ERROR = 26,               /**< reading or writing has failed */
  RR_BUFFER_LIMIT_VIOLATION = 27, /**< a queue is full, or something is larger than a limit */
  /** a definition has a mistake, or differs from the program's */
  RR_SERVICE_DEFINITION_ERROR = 28,
  RR_OUT_OF_RANGE = 29,           /**< an index, position or number outside of what there is */
  RR_KEY_NOT_FOUND = 30,          /**< a map has no such key */
  RR_INVALID_CONFIGURATION = 31,  /**< options, users, rights or certificates that cannot be used */
  RR_INVALID_STATE = 32,          /**< the object is not in a state for it */
  RR_REMOTE_ERROR = 100,          /**< an exception of a definition; the name says which */
  RR_REQUEST_TIMEOUT = 101,       /**< no answer in time */
  RR_READ_ONLY_MEMBER = 102,      /**< setting or sending what is readonly */
  RR_WRITE_ONLY_MEMBER = 103,     /**< getting or receiving what is writeonly */
  RR_NOT_IMPLEMENTED_ERROR = 104, /**< the service leaves this member out */
  RR_MEMBER_BUSY = 105,           /**< the member is in use */
  RR_VALUE_NOT_SET = 106,         /**< a wire has no value yet, or only one that has expired */
  RR_ABORT_OPERATION = 107,       /**< for a generator: break off */
  RR_OPERATION_ABORTED = 108,     /**< ended before it was done, by this side or the other */
  RR_STOP_ITERATION = 109,        /**< a generator has come to its end: no failure */
  RR_OPERATION_TIMEOUT = 110,     /**< the time to wait is over */
  /** ended by the program before its answer came */
  RR_OPERATION_CANCELLED = 111,
  RR_AUTHENTICATION_ERROR = 150, /**< a login was refused, or none was sent */
  RR_OBJECT_LOCKED_ERROR = 151,  /**< another user or session has locked the object */
  RR_PERMISSION_DENIED = 152     /**< the user may not do this */
};

/** What an error says. To be sent or shown by the side that has failed. */
typedef struct rr_error_info {
  size_t size;       /**< sizeof(rr_error_info), set by the caller */
  rr_status code;    /**< to be sent: RR_REMOTE_ERROR for an exception of a definition */
  uint32_t reserved; /**< 0 */
  rr_str name; /**< `RobotRaconteur.OutOfRange`, `example.probe.ProbeFault`; may be left empty to be
                  sent, where the code has a name of its own */
  rr_str subname;        /**< a second name inside of `name`; mostly empty */
  rr_str message;        /**< text for people */
  rr_elements parameter; /**< one varvalue, or count 0. Not of a named type. */
} rr_error_info;

/** An error that a function has stored for its caller, who releases it. It does not change. */
typedef struct rr_error rr_error;
/** Fills `*info`, whose size is set: views that are valid until the error is released. The name is
 * that of the code for codes that have one; an exception of a definition keeps its own. */
RR_API void rr_error_read(const rr_error* error, rr_error_info* info);
/** Releases an error, and with it all that rr_error_read has told. NULL is allowed. */
RR_API void rr_error_release(rr_error* error);

/** Checks elements and writes them in another version (2 or 4). `*out_data` is new. */
RR_API rr_status rr_elements_convert(const rr_elements* elements, uint32_t version,
                                     rr_data** out_data, rr_error** error);

/** Ends calls before their answers come: they fail with RR_OPERATION_CANCELLED, and the service is
 * not told. One may serve any number of calls. */
typedef struct rr_cancellation rr_cancellation;
/** Makes a cancellation that ends nothing yet. Release it with rr_cancellation_release. */
RR_API rr_status rr_cancellation_new(rr_cancellation** out_cancellation, rr_error** error);
/** Ends all calls that were and will be made with it. Does not wait. */
RR_API void rr_cancellation_cancel(rr_cancellation* cancellation);
/** The calls go on. */
RR_API void rr_cancellation_release(rr_cancellation* cancellation);

/** Modifiers of a member, as bits: what the definition says. */
enum {
  RR_READONLY = 1,    /**< clients get or receive only */
  RR_WRITEONLY = 2,   /**< clients set or send only */
  RR_UNRELIABLE = 4,  /**< pipe, wire: packets may be lost or overtake each other */
  RR_NOLOCK = 8,      /**< may be used while another user has locked the object */
  RR_NOLOCKREAD = 16, /**< the same for reading only */
  RR_PERCLIENT = 32,  /**< the service has a value for each client */
  RR_URGENT = 64      /**< sent before other messages that wait */
};

/** RR_NO_LIMIT, as a time: wait for as long as it takes. */
enum { RR_NO_LIMIT = -1 }; /* as a time-out */

/** How one call is made. NULL in its place: as the client or the node says. */
typedef struct rr_call_options {
  size_t size;                         /**< sizeof(rr_call_options), set by the caller */
  int32_t timeout_ms;                  /**< 0: that of the client or node; RR_NO_LIMIT */
  uint32_t access;                     /**< modifiers of the member; RR_URGENT counts here */
  const rr_cancellation* cancellation; /**< may be NULL; may be released when the call has begun */
} rr_call_options;

/** Where an asynchronous call ends. `done` is called exactly once, on a thread of the node, under
 * no lock and not inside the call that has begun it, if that has returned RR_OK, and else never.
 * After the node's shutdown it is called on a thread that exists for that only. `error` is NULL in
 * success and belongs to the function, as does `result`: what it is stands beside each function
 * that takes a completion, and it is NULL after a failure. Nothing is dropped: a context ends with
 * its completion. */
typedef struct rr_completion {
  void* context;                                              /**< passed to `done` */
  void (*done)(void* context, rr_error* error, void* result); /**< needed */
} rr_completion;

/** Ends a function's connection to what it is told of, when it is released: it is not called any
 * more once that returns, unless it is the caller itself, or the caller holds it up by waiting for
 * itself. */
typedef struct rr_subscription rr_subscription;
/** Ends the connection, waits for its function if that runs, and releases the handle. NULL is
 * allowed. */
RR_API void rr_subscription_release(rr_subscription* subscription);

/** Something that the program is asked for: by a client of its service, by a service whose client
 * it is, or by the runtime. Its receiver owns it, and answers or fails it exactly once, now or
 * later, from any thread; then, or without that, it releases it. One that is released unanswered
 * fails with RR_OPERATION_ABORTED. What info tells stays valid until the release. Where it is said
 * that a request waits, the thread of the node that asks waits for the answer; it does not while a
 * member of a service is answered later. */
typedef struct rr_request rr_request;

/** What an rr_request asks for, and how it is answered. A request that waits keeps a thread of the
 * node. */
enum {
  RR_REQUEST_GET = 1,       /**< of a property: one value */
  RR_REQUEST_SET = 2,       /**< of a property, whose value is the argument: nothing */
  RR_REQUEST_CALL = 3,      /**< of a function: one value, or nothing for void */
  RR_REQUEST_GENERATOR = 4, /**< of a function that gives a generator: rr_request_answer_generator.
                               Before the function that is asked returns. */
  RR_REQUEST_FIND = 5,      /**< of an objref: rr_request_answer_object. Waits. */
  RR_REQUEST_STEP = 6, /**< of a generator, with what it takes, if it does: one value, or nothing,
                          or rr_request_answer_end. Waits. */
  RR_REQUEST_PEEK_IN = 7,  /**< of a wire: one value. Waits. */
  RR_REQUEST_PEEK_OUT = 8, /**< the same */
  RR_REQUEST_CALLBACK =
      9, /**< of a callback, by the service: one value, or nothing for void. Waits. */
  RR_REQUEST_AUTHENTICATE = 10 /**< of users: rr_request_answer_user. Waits. `name` is the user, the
                                  argument one element: a map of strings to varvalues. */
};

/** What an rr_request asks for, and who asks. */
typedef struct rr_request_info {
  size_t size;             /**< sizeof(rr_request_info), set by the caller */
  uint32_t kind;           /**< RR_REQUEST_... */
  uint32_t member;         /**< place in the table of the object's members */
  rr_elements arguments;   /**< as received */
  uint32_t answer_version; /**< the version of the format in which the answer travels */
  uint32_t client;         /**< its endpoint's number in this node; 0 for none */
  int32_t index_number;    /**< RR_REQUEST_FIND with an int32 index */
  uint32_t reserved;       /**< 0 */
  rr_str name;     /**< RR_REQUEST_FIND with a string index: that; RR_REQUEST_AUTHENTICATE */
  rr_node_id node; /**< RR_REQUEST_AUTHENTICATE: what the client says of itself */
  uint64_t
      session; /**< of the client that asks, as in rr_client_info (minor version 2); 0 for none */
} rr_request_info;

/** Fills `*info`, whose size is set: what it refers to is valid until the request is released. */
RR_API void rr_request_read(const rr_request* request, rr_request_info* info);
/** With one value; NULL, or with a count of 0: nothing. RR_INVALID_OPERATION when it has been
 * answered, or wants another answer. */
RR_API rr_status rr_request_answer(rr_request* request, const rr_elements* value, rr_error** error);
/** The generator has come to its end. */
RR_API rr_status rr_request_answer_end(rr_request* request, rr_error** error);
/** Answers RR_REQUEST_AUTHENTICATE: the user is logged in as `name` and has these privileges.
 * RR_INVALID_OPERATION when the request is another one or has been answered. */
RR_API rr_status rr_request_answer_user(rr_request* request, rr_str name, const rr_str* privileges,
                                        size_t privilege_count, rr_error** error);
/** Fails the request: the other side gets this error. RR_INVALID_OPERATION when it has been
 * answered. */
RR_API rr_status rr_request_fail(rr_request* request, const rr_error_info* why, rr_error** error);
/** Releases the request, which fails with RR_OPERATION_ABORTED unless it was answered. NULL is
 * allowed. */
RR_API void rr_request_release(rr_request* request);

#ifdef __cplusplus
}
#endif

#endif
