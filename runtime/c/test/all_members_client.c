/* SPDX-License-Identifier: Apache-2.0 */
#include <pthread.h>
#include <stdio.h>
#include <string.h>

#include "all_members.h"
#include "packing.h"

/* What functions of the runtime have seen, and waiting for it. */
static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t changed = PTHREAD_COND_INITIALIZER;

static void count_up(int* counter) {
  pthread_mutex_lock(&mutex);
  ++*counter;
  pthread_cond_broadcast(&changed);
  pthread_mutex_unlock(&mutex);
}

static void wait_for(const int* counter, int value) {
  pthread_mutex_lock(&mutex);
  while (*counter < value) pthread_cond_wait(&changed, &mutex);
  pthread_mutex_unlock(&mutex);
}

#define REQUIRE(condition) \
  if (!(condition)) return #condition

static rr_client* connect_to(rr_node* node, uint16_t port, const char* service) {
  char url[128];
  rr_str urls[1];
  rr_client* client = NULL;
  snprintf(url, sizeof url, "rr+tcp://127.0.0.1:%u/?service=%s", (unsigned)port, service);
  urls[0] = str(url);
  if (rr_client_connect(node, urls, 1, NULL, &client, NULL) != RR_OK) return NULL;
  return client;
}

static rr_object* root_of(rr_client* client) {
  rr_object* root = NULL;
  return rr_client_root(client, &root, NULL) == RR_OK ? root : NULL;
}

/* Calls a function; the answer is to be released. */
static rr_status call(rr_object* object, const char* name, packer* arguments, rr_data** answer) {
  const rr_elements elements = packed(arguments);
  const rr_status status =
      rr_object_call(object, RR_FUNCTION_CALL, str(name), &elements, NULL, answer, NULL);
  packer_free(arguments);
  return status;
}

static void on_ticked(void* context, const rr_elements* arguments, rr_data* data) {
  unpacked count;
  (void)data;
  if (unpack(arguments, "count", &count) && unpack_is_text(arguments, "text", "root")) {
    count_up(context);
  }
}

typedef struct completion_state {
  int done;
  rr_status status;
  rr_data* data;
} completion_state;

static void on_done(void* context, rr_error* error, void* result) {
  completion_state* state = context;
  rr_error_info info;
  memset(&info, 0, sizeof info);
  info.size = sizeof info;
  if (error != NULL) rr_error_read(error, &info);
  state->status = info.code;
  state->data = result;
  rr_error_release(error);
  count_up(&state->done);
}

static const char* use_counter(rr_object* counter) {
  packer value = {0};
  packer arguments = {0};
  rr_elements elements;
  rr_data* answer = NULL;
  rr_object* found = NULL;
  rr_error* error = NULL;
  rr_error_info info;
  rr_index index;
  unpacked blob;
  completion_state state;
  rr_completion completion;

  pack_double(&value, "value", 2.5);
  elements = packed(&value);
  REQUIRE(rr_object_call(counter, RR_PROPERTY_SET, str("value"), &elements, NULL, &answer, NULL) ==
          RR_OK);
  packer_free(&value);
  REQUIRE(rr_data_elements(answer).count == 0);
  rr_data_release(answer);
  REQUIRE(rr_object_call(counter, RR_PROPERTY_GET, str("value"), NULL, NULL, &answer, NULL) ==
          RR_OK);
  elements = rr_data_elements(answer);
  REQUIRE(unpack_double(&elements, "value") == 2.5);
  rr_data_release(answer);

  pack_double(&arguments, "a", 1);
  pack_double(&arguments, "b", 2);
  REQUIRE(call(counter, "add", &arguments, &answer) == RR_OK);
  elements = rr_data_elements(answer);
  REQUIRE(unpack_double(&elements, "return") == 3);
  rr_data_release(answer);

  pack_int32(&arguments, "code", 0);
  pack_text(&arguments, "text", "as planned");
  elements = packed(&arguments);
  REQUIRE(rr_object_call(counter, RR_FUNCTION_CALL, str("raise"), &elements, NULL, &answer,
                         &error) == RR_REMOTE_ERROR);
  packer_free(&arguments);
  memset(&info, 0, sizeof info);
  info.size = sizeof info;
  rr_error_read(error, &info);
  REQUIRE(answer == NULL && info.code == RR_REMOTE_ERROR);
  REQUIRE(info.message.size == 10 && memcmp(info.message.data, "as planned", 10) == 0);
  REQUIRE(info.name.size == 20 && memcmp(info.name.data, "test.counter.Overrun", 20) == 0);
  REQUIRE(info.subname.size == 4 && memcmp(info.subname.data, "deep", 4) == 0);
  REQUIRE(info.parameter.count == 1 && unpack(&info.parameter, NULL, &blob) && blob.count == 2);
  rr_error_release(error);

  index.form = RR_INDEX_STRING;
  index.text = str("one two");
  REQUIRE(rr_object_find(counter, str("by_name"), &index, str("test.counter.Named"), NULL, &found,
                         NULL) == RR_OK);
  REQUIRE(rr_object_is_a(found, str("test.counter.Counter")) == 1);
  REQUIRE(rr_object_is_a(found, str("test.counter.Other")) == 0);
  REQUIRE(rr_object_call(found, RR_PROPERTY_GET, str("name"), NULL, NULL, &answer, NULL) == RR_OK);
  elements = rr_data_elements(answer);
  REQUIRE(unpack_is_text(&elements, "value", "name one two"));
  rr_data_release(answer);
  rr_object_release(found);

  pack_uint32(&arguments, "size", 200000);
  elements = packed(&arguments);
  memset(&state, 0, sizeof state);
  completion.context = &state;
  completion.done = on_done;
  REQUIRE(rr_object_call_async(counter, RR_FUNCTION_CALL, str("blob"), &elements, NULL, &completion,
                               NULL) == RR_OK);
  packer_free(&arguments);
  wait_for(&state.done, 1);
  REQUIRE(state.status == RR_OK);
  elements = rr_data_elements(state.data);
  REQUIRE(unpack(&elements, "return", &blob) && blob.count == 200000);
  REQUIRE(blob.payload[100] == (uint8_t)(100 * 31 + 7));
  rr_data_release(state.data);
  return NULL;
}

static const char* use_events(rr_object* counter) {
  int ticks = 0;
  rr_event_handler handler = {0};
  rr_subscription* ticked = NULL;
  rr_data* answer = NULL;
  packer arguments = {0};
  handler.size = sizeof handler;
  handler.context = &ticks;
  handler.on_event = on_ticked;
  REQUIRE(rr_event_subscribe(counter, str("ticked"), &handler, &ticked, NULL) == RR_OK);
  pack_int32(&arguments, "count", 3);
  REQUIRE(call(counter, "fire", &arguments, &answer) == RR_OK);
  rr_data_release(answer);
  wait_for(&ticks, 3);
  rr_subscription_release(ticked);
  return NULL;
}

static void on_sum(void* context, rr_request* request) {
  rr_request_info info = {0};
  packer answer = {0};
  rr_elements elements;
  info.size = sizeof info;
  rr_request_read(request, &info);
  pack_int32(&answer, "sum",
             unpack_int32(&info.arguments, "a") + unpack_int32(&info.arguments, "b"));
  elements = packed(&answer);
  rr_request_answer(request, &elements, NULL);
  rr_request_release(request);
  packer_free(&answer);
  count_up(context);
}

static const char* use_board(rr_object* board) {
  int calls = 0;
  int steps = 0;
  rr_callback_handler handler = {0};
  rr_data* answer = NULL;
  rr_generator* generator = NULL;
  rr_status status = RR_OK;
  packer arguments = {0};
  rr_elements elements;
  handler.size = sizeof handler;
  handler.context = &calls;
  handler.on_call = on_sum;
  REQUIRE(rr_callback_set(board, str("sum"), 0, 1, &handler, NULL) == RR_OK);
  pack_text(&arguments, "what", "sum");
  REQUIRE(call(board, "run", &arguments, &answer) == RR_OK);
  elements = rr_data_elements(answer);
  REQUIRE(unpack_double(&elements, "return") == 42 && calls == 1);
  rr_data_release(answer);
  REQUIRE(rr_callback_clear(board, str("sum"), NULL) == RR_OK);

  pack_int32(&arguments, "limit", 3);
  elements = packed(&arguments);
  REQUIRE(rr_generator_open(board, str("count_to"), &elements, NULL, &generator, NULL) == RR_OK);
  packer_free(&arguments);
  while ((status = rr_generator_next(generator, NULL, NULL, &answer, NULL)) == RR_OK) {
    rr_data_release(answer);
    ++steps;
  }
  REQUIRE(status == RR_STOP_ITERATION && answer == NULL && steps == 3);
  rr_generator_release(generator);
  return NULL;
}

static const char* use_pipes(rr_object* pipes) {
  int i;
  uint32_t number = 0;
  rr_pipe* pipe = NULL;
  rr_data* answer = NULL;
  packer packet = {0};
  rr_elements elements;
  REQUIRE(rr_pipe_connect(pipes, str("numbers"), NULL, NULL, &pipe, NULL) == RR_OK);
  rr_pipe_ask_for_acknowledgements(pipe, 1);
  pack_double(&packet, "any name", 1.5);
  elements = packed(&packet);
  REQUIRE(rr_pipe_send(pipe, &elements, &number, NULL) == RR_OK && number == 1);
  REQUIRE(call(pipes, "sync", &(packer){0}, &answer) == RR_OK);
  rr_data_release(answer);
  packer_free(&packet);
  for (i = 0; i < 20; ++i) {
    REQUIRE(rr_pipe_wait(pipe, 20000) == 1);
    REQUIRE(rr_pipe_receive(pipe, &answer, NULL) == RR_OK && answer != NULL);
    elements = rr_data_elements(answer);
    REQUIRE(unpack_double(&elements, NULL) == i);
    rr_data_release(answer);
  }
  while (rr_pipe_unacknowledged(pipe) != 0) rr_pipe_wait(pipe, 1);
  rr_pipe_close(pipe);
  REQUIRE(rr_pipe_is_open(pipe) == 0);
  rr_pipe_release(pipe);
  return NULL;
}

static const char* use_wired(rr_object* wired) {
  rr_wire* wire = NULL;
  rr_data* value = NULL;
  rr_data* answer = NULL;
  rr_time time = {0};
  packer arguments = {0};
  packer number = {0};
  rr_elements elements;
  REQUIRE(rr_wire_connect(wired, str("level"), 0, NULL, &wire, NULL) == RR_OK);
  pack_double(&arguments, "value", 4.5);
  REQUIRE(call(wired, "set_level", &arguments, &answer) == RR_OK);
  rr_data_release(answer);
  REQUIRE(rr_wire_wait(wire, 20000) == 1);
  REQUIRE(rr_wire_received(wire, &value, &time, NULL) == RR_OK && time.seconds != 0);
  elements = rr_data_elements(value);
  REQUIRE(unpack_double(&elements, NULL) == 4.5);
  rr_data_release(value);
  pack_double(&number, "", -1.5);
  elements = packed(&number);
  REQUIRE(rr_wire_send(wire, &elements, NULL) == RR_OK);
  REQUIRE(rr_wire_sent(wire, &value, NULL, NULL) == RR_OK);
  elements = rr_data_elements(value);
  REQUIRE(unpack_double(&elements, NULL) == -1.5);
  rr_data_release(value);
  REQUIRE(rr_wire_peek_in(wired, str("level"), NULL, &value, &time, NULL) == RR_OK);
  elements = rr_data_elements(value);
  REQUIRE(unpack_double(&elements, NULL) == 4.5);
  rr_data_release(value);
  elements = packed(&number);
  REQUIRE(rr_wire_poke_out(wired, str("level"), &elements, NULL, NULL) == RR_OK);
  packer_free(&number);
  rr_wire_close(wire);
  rr_wire_release(wire);
  return NULL;
}

static const char* use_store(rr_object* store) {
  static const double written[] = {1, 2, 3};
  static const uint64_t count[] = {3};
  static const uint64_t outside[] = {99};
  double read[3] = {0};
  uint64_t position[] = {0};
  uint64_t length = 0;
  rr_memory_type type = {0};
  type.element = PACK_DOUBLE;
  REQUIRE(rr_memory_write(store, str("numbers"), &type, position, count, 1, written, sizeof written,
                          NULL, NULL) == RR_OK);
  REQUIRE(rr_memory_read(store, str("numbers"), &type, position, count, 1, read, sizeof read, NULL,
                         NULL) == RR_OK);
  REQUIRE(memcmp(written, read, sizeof read) == 0);
  REQUIRE(rr_memory_length(store, str("numbers"), NULL, &length, NULL) == RR_OK && length == 100);
  REQUIRE(rr_memory_read(store, str("numbers"), &type, outside, count, 1, read, sizeof read, NULL,
                         NULL) == RR_OUT_OF_RANGE);
  return NULL;
}

typedef const char* (*use_function)(rr_object*);

static const char* use(rr_node* node, uint16_t port, const char* service, use_function function) {
  const char* wrong = NULL;
  rr_client* const client = connect_to(node, port, service);
  rr_object* root = NULL;
  if (client == NULL) return service;
  root = root_of(client);
  wrong = root != NULL ? function(root) : "root";
  rr_object_release(root);
  rr_client_release(client);
  return wrong;
}

const char* all_members_use(rr_node* node, uint16_t port) {
  static const struct {
    const char* service;
    use_function function;
  } uses[] = {{"counter", use_counter}, {"counter", use_events}, {"board", use_board},
              {"pipes", use_pipes},     {"wired", use_wired},    {"store", use_store}};
  size_t i;
  for (i = 0; i < sizeof uses / sizeof uses[0]; ++i) {
    const char* const wrong = use(node, port, uses[i].service, uses[i].function);
    if (wrong != NULL) return wrong;
  }
  return NULL;
}
