/* SPDX-License-Identifier: Apache-2.0 */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "service_parts.h"

static const char counter_text[] =
    "service test.counter\n"
    "stdver 0.10\n"
    "exception Overrun\n"
    "struct Reading\n"
    "  field double value\n"
    "  field string label\n"
    "  field uint8[] picture\n"
    "end\n"
    "object Named\n"
    "  property string name [readonly]\n"
    "end\n"
    "object Counter\n"
    "  implements Named\n"
    "  property string name [readonly]\n"
    "  property double value\n"
    "  property double fixed [readonly]\n"
    "  property double hidden [writeonly]\n"
    "  function double add(double a, double b)\n"
    "  function void reset()\n"
    "  function string echo(string text)\n"
    "  function Reading read(string label)\n"
    "  function uint8[] blob(uint32 size)\n"
    "  function uint64 take(double[] numbers)\n"
    "  function void raise(int32 code, string text)\n"
    "  function void slow(int32 milliseconds)\n"
    "  function void fire(int32 count)\n"
    "  function varvalue any(varvalue value)\n"
    "  event ticked(int32 count, string text)\n"
    "  objref Counter child\n"
    "  objref Counter{int32} by_number\n"
    "  objref Counter{string} by_name\n"
    "  objref varobject anything\n"
    "end\n";

enum {
  COUNTER_NAME,
  COUNTER_VALUE,
  COUNTER_ADD,
  COUNTER_ECHO,
  COUNTER_BLOB,
  COUNTER_RAISE,
  COUNTER_SLOW,
  COUNTER_FIRE,
  COUNTER_ANY,
  COUNTER_TICKED,
  COUNTER_BY_NAME,
  COUNTER_MEMBERS
};

typedef struct counter {
  char name[64];
  double value;
  rr_object_type* type; /* borrowed: outlives all objects */
  rr_served_object* self;
} counter;

static void fail(rr_request* request, rr_status code, const char* name, const char* subname,
                 const unpacked* message, const packer* parameter) {
  rr_error_info why = {0};
  why.size = sizeof why;
  why.code = code;
  why.name = str(name);
  why.subname = str(subname);
  if (message != NULL) {
    why.message.data = (const char*)message->payload;
    why.message.size = message->size;
  }
  if (parameter != NULL) why.parameter = packed(parameter);
  rr_request_fail(request, &why, NULL);
}

static void raise_error(rr_request* request, const rr_elements* arguments) {
  static const double numbers[] = {0.5, -0.25};
  const int32_t code = unpack_int32(arguments, "code");
  unpacked text;
  packer parameter = {0};
  unpack(arguments, "text", &text);
  if (code != 0) {
    fail(request, code, "", "", &text, NULL);
    return;
  }
  pack(&parameter, "errorparam", PACK_DOUBLE, numbers, sizeof numbers, 2);
  fail(request, RR_REMOTE_ERROR, "test.counter.Overrun", "deep", &text, &parameter);
  packer_free(&parameter);
}

static void give_blob(packer* value, const rr_elements* arguments) {
  const uint32_t size = (uint32_t)unpack_int32(arguments, "size");
  uint8_t* const bytes = malloc(size + 1);
  uint32_t i;
  if (bytes == NULL) abort();
  for (i = 0; i < size; ++i) bytes[i] = (uint8_t)(i * 31 + 7);
  pack(value, "return", PACK_UINT8, bytes, size, size);
  free(bytes);
}

static void fire(const counter* of, int32_t count) {
  int32_t i;
  for (i = 0; i < count; ++i) {
    packer arguments = {0};
    rr_elements elements;
    pack_int32(&arguments, "count", i);
    pack_text(&arguments, "text", of->name);
    elements = packed(&arguments);
    rr_served_event_fire(of->self, COUNTER_TICKED, &elements, NULL);
    packer_free(&arguments);
  }
}

static void find_by_name(const counter* of, rr_request* request, rr_str index) {
  char name[64] = "name ";
  rr_served_object* found = NULL;
  const size_t size = index.size < 50 ? index.size : 50;
  memcpy(name + 5, index.data, size);
  found = make_counter(of->type, name, 5 + size);
  rr_request_answer_object(request, found, 0, NULL);
  rr_served_object_release(found);
}

/* Answers later, from another thread. */
static void* answer_later(void* request) {
  rr_request_answer(request, NULL, NULL);
  rr_request_release(request);
  return NULL;
}

static void on_counter(void* context, rr_request* request, const rr_request_info* info) {
  counter* const of = context;
  packer value = {0};
  unpacked text;
  pthread_t thread;
  pthread_attr_t detached;
  switch (info->member) {
    case COUNTER_NAME:
      pack_text(&value, "value", of->name);
      answer(request, &value);
      break;
    case COUNTER_VALUE:
      if (info->kind == RR_REQUEST_SET) {
        of->value = unpack_double(&info->arguments, "value");
      } else {
        pack_double(&value, "value", of->value);
      }
      answer(request, &value);
      break;
    case COUNTER_ADD:
      pack_double(&value, "return",
                  unpack_double(&info->arguments, "a") + unpack_double(&info->arguments, "b"));
      answer(request, &value);
      break;
    case COUNTER_ECHO:
      unpack(&info->arguments, "text", &text);
      pack(&value, "return", PACK_STRING, text.payload, text.size, text.count);
      answer(request, &value);
      break;
    case COUNTER_BLOB:
      give_blob(&value, &info->arguments);
      answer(request, &value);
      break;
    case COUNTER_RAISE:
      raise_error(request, &info->arguments);
      break;
    case COUNTER_SLOW:
      /* Not pthread_detach(), with which winpthreads may lose a thread. */
      pthread_attr_init(&detached);
      pthread_attr_setdetachstate(&detached, PTHREAD_CREATE_DETACHED);
      if (pthread_create(&thread, &detached, answer_later, request) != 0) abort();
      pthread_attr_destroy(&detached);
      return;
    case COUNTER_FIRE:
      fire(of, unpack_int32(&info->arguments, "count"));
      answer(request, &value);
      break;
    case COUNTER_ANY:
      rr_request_answer(request, &info->arguments, NULL); /* under another name */
      break;
    case COUNTER_BY_NAME:
      find_by_name(of, request, info->name);
      break;
    default:
      break; /* released unanswered */
  }
  rr_request_release(request);
}

rr_served_object* make_counter(rr_object_type* type, const char* name, size_t size) {
  counter* const of = make_context(sizeof *of);
  rr_object_handler handler = {0};
  memcpy(of->name, name, size);
  of->type = type;
  handler.context = of;
  handler.on_request = on_counter;
  of->self = make_object(type, &handler);
  return of->self;
}

rr_object_type* counter_type(rr_definition** definition) {
  rr_member members[COUNTER_MEMBERS];
  members[COUNTER_NAME] = member("name", RR_PROPERTY, RR_READONLY, 0);
  members[COUNTER_VALUE] = member("value", RR_PROPERTY, 0, 0);
  members[COUNTER_ADD] = member("add", RR_FUNCTION, 0, 1);
  members[COUNTER_ECHO] = member("echo", RR_FUNCTION, 0, 1);
  members[COUNTER_BLOB] = member("blob", RR_FUNCTION, 0, 1);
  members[COUNTER_RAISE] = member("raise", RR_FUNCTION, 0, 0);
  members[COUNTER_SLOW] = member("slow", RR_FUNCTION, 0, 0);
  members[COUNTER_FIRE] = member("fire", RR_FUNCTION, 0, 0);
  members[COUNTER_ANY] = member("any", RR_FUNCTION, 0, 1);
  members[COUNTER_TICKED] = member("ticked", RR_EVENT, 0, 0);
  members[COUNTER_BY_NAME] = member("by_name", RR_OBJREF, 0, 0);
  members[COUNTER_BY_NAME].index = RR_INDEX_STRING;
  members[COUNTER_BY_NAME].object_type = str("test.counter.Counter");
  return make_type(counter_text, NULL, "Counter", members, COUNTER_MEMBERS, definition);
}
