/* SPDX-License-Identifier: Apache-2.0 */
#ifndef RR_H
#define RR_H

/** @file
 * The runtime for other languages: C, ABI version 1. docs/reference/c-abi.md says more and has an
 * example.
 *
 * Handles. Everything that is made is an opaque handle, released once with rr_<noun>_release. NULL
 * is allowed there, and any thread may do it in any state of the thing, in functions that the
 * runtime calls too, also in those that belong to the thing itself. As with free(), no other call
 * may be using the same handle then, or use it afterwards. What a handle has begun (a call, a
 * connected pipe, a service) does not end with it unless its release says so. Handles may outlive
 * the node; calls with them then fail.
 *
 * Errors. A function that may fail returns an rr_status: RR_OK, or the code of the error, and then
 * stores a new rr_error in `*error`, unless `error` is NULL; the caller releases it. In success
 * `*error` is set to NULL. Outputs that are handles are NULL after a failure. A NULL handle or
 * function, or a struct of an unknown size, gives RR_INVALID_ARGUMENT. No exception comes out of
 * this library, and none may come out of a function that it calls.
 *
 * Structs. Those that may grow begin with `size`: sizeof the struct as the caller knows it. All
 * zero but the size means the defaults. Pointers in them are read during the call only, unless said
 * otherwise.
 *
 * Values. The runtime carries values as elements, packed as they travel, and the language reads and
 * writes them: see rr_elements. It never looks at definitions of structs, enums or exceptions.
 *
 * Functions that the runtime calls come with a `context`. They run on threads of the node, never
 * under a lock, and never inside a call that the program makes, except where it is said; they may
 * call anything here. What they are given without a word about owning is theirs until they return.
 * `drop` is called once with the context when none of the others will be called any more; it may be
 * NULL, as may all functions of which it is not said that they are needed. drop is also called when
 * the function that was given the struct fails, unless it does for the struct's size.
 *
 * Threads. All functions may be called from any thread at once. docs/explanation/threads.md says
 * who runs what.
 */

#include "rr_c/client.h"
#include "rr_c/discovery.h"
#include "rr_c/filters.h"
#include "rr_c/node.h"
#include "rr_c/security.h"
#include "rr_c/service.h"
#include "rr_c/streams.h"
#include "rr_c/subscriptions.h"
#include "rr_c/values.h"

#endif
