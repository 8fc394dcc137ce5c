/* SPDX-License-Identifier: Apache-2.0 */
#include "service_parts.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "all_members.h"

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static int contexts = 0;

int all_members_contexts(void) {
  int result;
  pthread_mutex_lock(&mutex);
  result = contexts;
  pthread_mutex_unlock(&mutex);
  return result;
}

static void count_contexts(int by) {
  pthread_mutex_lock(&mutex);
  contexts += by;
  pthread_mutex_unlock(&mutex);
}

void* make_context(size_t size) {
  void* const context = calloc(1, size);
  if (context == NULL) abort();
  count_contexts(1);
  return context;
}

void drop_context(void* context) {
  free(context);
  count_contexts(-1);
}

void answer(rr_request* request, packer* value) {
  const rr_elements elements = packed(value);
  rr_request_answer(request, value->count != 0 ? &elements : NULL, NULL);
  packer_free(value);
}

rr_member member(const char* name, uint32_t kind, uint32_t access, uint32_t returns_value) {
  rr_member result;
  memset(&result, 0, sizeof result);
  result.name = str(name);
  result.kind = kind;
  result.access = access;
  result.returns_value = returns_value;
  return result;
}

rr_served_object* make_object(rr_object_type* type, rr_object_handler* handler) {
  rr_served_object* served = NULL;
  handler->size = sizeof *handler;
  handler->drop = drop_context;
  if (rr_served_object_new(type, handler, &served, NULL) != RR_OK) abort();
  return served;
}

rr_object_type* make_type(const char* text, rr_definition* import, const char* name,
                          const rr_member* members, size_t count, rr_definition** definition) {
  rr_object_type* type = NULL;
  rr_definition* made = NULL;
  if (rr_definition_new(str(text), &import, import != NULL ? 1 : 0, &made, NULL) != RR_OK ||
      rr_object_type_new(made, str(name), members, count, sizeof *members, &type, NULL) != RR_OK) {
    abort();
  }
  if (definition != NULL) {
    *definition = made;
  } else {
    rr_definition_release(made);
  }
  return type;
}

rr_served_object* make_plain(rr_object_type* type,
                             void (*on_request)(void*, rr_request*, const rr_request_info*)) {
  object* const of = make_context(sizeof *of);
  rr_object_handler handler = {0};
  handler.context = of;
  handler.on_request = on_request;
  of->self = make_object(type, &handler);
  return of->self;
}
