/* SPDX-License-Identifier: Apache-2.0 */
#include <stdlib.h>
#include <string.h>

#include "all_members.h"
#include "service_parts.h"

/* The pipes. */

static const char pipes_text[] =
    "service test.pipes\n"
    "stdver 0.10\n"
    "import test.counter\n"
    "object PipeBoard\n"
    "  pipe double numbers\n"
    "  pipe test.counter.Reading readings\n"
    "  pipe uint8[] blobs\n"
    "  pipe int32 out [readonly]\n"
    "  pipe string in [writeonly]\n"
    "  pipe int32 lossy [unreliable]\n"
    "  function void sync()\n"
    "  objref PipeBoard child\n"
    "end\n";

enum { PIPES_NUMBERS, PIPES_SYNC, PIPES_MEMBERS };

static void on_connected(void* context, rr_pipe* pipe) {
  (void)context;
  rr_pipe_release(pipe); /* it stays connected */
}

static void on_pipes(void* context, rr_request* request, const rr_request_info* info) {
  const object* const of = context;
  packer nothing = {0};
  int i;
  (void)info;
  for (i = 0; i < 20; ++i) {
    packer packet = {0};
    rr_elements elements;
    pack_double(&packet, "packet", i);
    elements = packed(&packet);
    rr_served_pipe_send(of->self, PIPES_NUMBERS, &elements, NULL);
    packer_free(&packet);
  }
  answer(request, &nothing);
  rr_request_release(request);
}

static rr_object_type* pipes_type(rr_definition* counters) {
  rr_member members[PIPES_MEMBERS];
  members[PIPES_NUMBERS] = member("numbers", RR_PIPE, 0, 0);
  members[PIPES_SYNC] = member("sync", RR_FUNCTION, 0, 0);
  return make_type(pipes_text, counters, "PipeBoard", members, PIPES_MEMBERS, NULL);
}

/* The wires. */

static const char wired_text[] =
    "service test.wired\n"
    "stdver 0.10\n"
    "object Wired\n"
    "  wire double level\n"
    "  wire string note\n"
    "  wire double[] trace\n"
    "  wire double reading [readonly]\n"
    "  wire double target [writeonly]\n"
    "  function void set_level(double value)\n"
    "  function void close_level()\n"
    "  objref Wired{string} child\n"
    "end\n";

enum { WIRED_LEVEL, WIRED_SET_LEVEL, WIRED_MEMBERS };

static void on_wired(void* context, rr_request* request, const rr_request_info* info) {
  const object* const of = context;
  packer nothing = {0};
  rr_served_wire_send(of->self, WIRED_LEVEL, &info->arguments, NULL);
  answer(request, &nothing);
  rr_request_release(request);
}

static rr_object_type* wired_type(void) {
  rr_member members[WIRED_MEMBERS];
  members[WIRED_LEVEL] = member("level", RR_WIRE, 0, 0);
  members[WIRED_SET_LEVEL] = member("set_level", RR_FUNCTION, 0, 0);
  return make_type(wired_text, NULL, "Wired", members, WIRED_MEMBERS, NULL);
}

/* The store. */

static const char store_text[] =
    "service test.store\n"
    "stdver 0.10\n"
    "object Store\n"
    "  memory double[] numbers\n"
    "end\n";

typedef struct store {
  double numbers[100];
} store;

static rr_status on_dims(void* context, uint64_t* dims, size_t room, size_t* count) {
  (void)context;
  if (room < 1) return RR_INTERNAL_ERROR;
  dims[0] = 100;
  *count = 1;
  return RR_OK;
}

static rr_status on_read(void* context, const uint64_t* position, const uint64_t* count,
                         size_t dim_count, void* items, size_t size) {
  const store* const of = context;
  (void)count;
  (void)dim_count;
  memcpy(items, of->numbers + position[0], size);
  return RR_OK;
}

static rr_status on_write(void* context, const uint64_t* position, const uint64_t* count,
                          size_t dim_count, const void* items, size_t size) {
  store* const of = context;
  (void)count;
  (void)dim_count;
  memcpy(of->numbers + position[0], items, size);
  return RR_OK;
}

static void on_store(void* context, rr_request* request, const rr_request_info* info) {
  (void)context;
  (void)info;
  rr_request_release(request);
}

static rr_object_type* store_type(void) {
  rr_member members[1];
  members[0] = member("numbers", RR_MEMORY, 0, 0);
  members[0].memory.element = PACK_DOUBLE;
  return make_type(store_text, NULL, "Store", members, 1, NULL);
}

static void set_memory(rr_served_object* of) {
  rr_memory_source source = {0};
  source.size = sizeof source;
  source.context = make_context(sizeof(store));
  source.dims = on_dims;
  source.read = on_read;
  source.write = on_write;
  source.drop = drop_context;
  if (rr_served_memory_set(of, 0, &source, NULL) != RR_OK) abort();
}

/* All of them. */

enum { OBJECTS = 5 };

struct all_members {
  rr_definition* counters;
  rr_object_type* types[OBJECTS];
  rr_served_object* objects[OBJECTS];
};

all_members* all_members_offer(rr_node* node) {
  static const char* const names[OBJECTS] = {"counter", "board", "pipes", "wired", "store"};
  all_members* const offered = calloc(1, sizeof *offered);
  rr_served_pipe_handler pipe_handler = {0};
  int i;
  if (offered == NULL) abort();
  offered->types[0] = counter_type(&offered->counters);
  offered->types[1] = board_type();
  offered->types[2] = pipes_type(offered->counters);
  offered->types[3] = wired_type();
  offered->types[4] = store_type();
  offered->objects[0] = make_counter(offered->types[0], "root", 4);
  offered->objects[1] = make_board(offered->types[1]);
  offered->objects[2] = make_plain(offered->types[2], on_pipes);
  offered->objects[3] = make_plain(offered->types[3], on_wired);
  offered->objects[4] = make_plain(offered->types[4], on_store);
  pipe_handler.size = sizeof pipe_handler;
  pipe_handler.on_connect = on_connected;
  if (rr_served_pipe_set_handler(offered->objects[2], PIPES_NUMBERS, &pipe_handler, NULL) !=
      RR_OK) {
    abort();
  }
  set_memory(offered->objects[4]);
  for (i = 0; i < OBJECTS; ++i) {
    if (rr_service_register(node, str(names[i]), offered->objects[i], NULL, NULL, NULL) != RR_OK) {
      all_members_release(offered);
      return NULL;
    }
  }
  return offered;
}

void all_members_release(all_members* offered) {
  int i;
  if (offered == NULL) return;
  for (i = 0; i < OBJECTS; ++i) {
    rr_served_object_release(offered->objects[i]);
    rr_object_type_release(offered->types[i]);
  }
  rr_definition_release(offered->counters);
  free(offered);
}
