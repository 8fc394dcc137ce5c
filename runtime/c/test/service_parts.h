/* SPDX-License-Identifier: Apache-2.0 */
#ifndef RR_TEST_SERVICE_PARTS_H
#define RR_TEST_SERVICE_PARTS_H

/* What the services of all_members_service.c are made of. */

#include "packing.h"
#include "rr.h"

/* The context of an object that needs nothing but itself. */
typedef struct object {
  rr_served_object* self;
} object;

/* Counted until it is dropped; all zero. */
void* make_context(size_t size);
void drop_context(void* context);

rr_member member(const char* name, uint32_t kind, uint32_t access, uint32_t returns_value);
/* The type of an object, and its definition unless that is NULL. `import` may be NULL. */
rr_object_type* make_type(const char* text, rr_definition* import, const char* name,
                          const rr_member* members, size_t count, rr_definition** definition);
/* The handler's size and drop are set here; its context is one of make_context. */
rr_served_object* make_object(rr_object_type* type, rr_object_handler* handler);
rr_served_object* make_plain(rr_object_type* type,
                             void (*on_request)(void*, rr_request*, const rr_request_info*));
/* Answers with what is in the packer, and frees that. */
void answer(rr_request* request, packer* value);

/* The counter and the board. */
rr_object_type* counter_type(rr_definition** definition);
rr_served_object* make_counter(rr_object_type* type, const char* name, size_t size);
rr_object_type* board_type(void);
rr_served_object* make_board(rr_object_type* type);

#endif
