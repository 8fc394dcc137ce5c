/* SPDX-License-Identifier: Apache-2.0 */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "all_members.h"
#include "packing.h"

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

static void* make_context(size_t size) {
  void* const context = calloc(1, size);
  if (context == NULL) abort();
  count_contexts(1);
  return context;
}

static void drop_context(void* context) {
  free(context);
  count_contexts(-1);
}

/* The counter. */

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

static rr_served_object* make_counter(rr_object_type* type, const char* name, size_t size);

static void answer(rr_request* request, packer* value) {
  const rr_elements elements = packed(value);
  rr_request_answer(request, value->count != 0 ? &elements : NULL, NULL);
  packer_free(value);
}

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
      if (pthread_create(&thread, NULL, answer_later, request) != 0) abort();
      pthread_detach(thread);
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

static rr_member member(const char* name, uint32_t kind, uint32_t access, uint32_t returns_value) {
  rr_member result;
  memset(&result, 0, sizeof result);
  result.name = str(name);
  result.kind = kind;
  result.access = access;
  result.returns_value = returns_value;
  return result;
}

static rr_served_object* make_object(rr_object_type* type, rr_object_handler* handler) {
  rr_served_object* object = NULL;
  handler->size = sizeof *handler;
  handler->drop = drop_context;
  if (rr_served_object_new(type, handler, &object, NULL) != RR_OK) abort();
  return object;
}

static rr_served_object* make_counter(rr_object_type* type, const char* name, size_t size) {
  counter* const of = make_context(sizeof *of);
  rr_object_handler handler = {0};
  memcpy(of->name, name, size);
  of->type = type;
  handler.context = of;
  handler.on_request = on_counter;
  of->self = make_object(type, &handler);
  return of->self;
}

static rr_object_type* make_type(const char* text, rr_definition* import, const char* name,
                                 const rr_member* members, size_t count,
                                 rr_definition** definition) {
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

static rr_object_type* counter_type(rr_definition** definition) {
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

/* The board. */

static const char board_text[] =
    "service test.board\n"
    "stdver 0.10\n"
    "exception Jam\n"
    "struct Note\n"
    "  field string text\n"
    "  field double[] numbers\n"
    "end\n"
    "object Board\n"
    "  callback void ping()\n"
    "  callback int32 sum(int32 a, int32 b)\n"
    "  callback Note describe(string text, double[] numbers)\n"
    "  callback double fail(string text)\n"
    "  function double run(string what)\n"
    "  function int32{generator} count_to(int32 limit)\n"
    "  function string{generator} names(string label)\n"
    "  function Note{generator} notes()\n"
    "  function void collect(string label, double{generator} value)\n"
    "  function double{generator} running_sum(double start, double{generator} value)\n"
    "  event note_down(string text)\n"
    "  objref Board child\n"
    "end\n";

enum { BOARD_SUM, BOARD_RUN, BOARD_COUNT_TO, BOARD_RUNNING_SUM, BOARD_NOTE_DOWN, BOARD_MEMBERS };

typedef struct object {
  rr_served_object* self;
} object;

typedef struct counting {
  int32_t next;
  int32_t limit;
  double sum;
} counting;

static void on_count(void* context, rr_request* request, const rr_request_info* info) {
  counting* const of = context;
  packer value = {0};
  if (info->arguments.count != 0) {
    of->sum += unpack_double(&info->arguments, NULL);
    pack_double(&value, "return", of->sum);
    answer(request, &value);
  } else if (of->next < of->limit) {
    pack_int32(&value, "return", of->next++);
    answer(request, &value);
  } else {
    rr_request_answer_end(request, NULL);
  }
  rr_request_release(request);
}

static void run(const object* of, rr_request* request, uint32_t client) {
  packer note = {0};
  packer numbers = {0};
  packer value = {0};
  rr_elements elements;
  rr_data* sum = NULL;
  pack_text(&note, "text", "asked");
  elements = packed(&note);
  rr_served_event_fire(of->self, BOARD_NOTE_DOWN, &elements, NULL);
  pack_int32(&numbers, "a", 20);
  pack_int32(&numbers, "b", 22);
  elements = packed(&numbers);
  if (rr_served_callback_call(of->self, BOARD_SUM, client, &elements, NULL, &sum, NULL) == RR_OK) {
    elements = rr_data_elements(sum);
    pack_double(&value, "return", unpack_int32(&elements, NULL));
    answer(request, &value);
    rr_data_release(sum);
  }
  packer_free(&note);
  packer_free(&numbers);
}

static void on_board(void* context, rr_request* request, const rr_request_info* info) {
  object* const of = context;
  if (info->member == BOARD_RUN) {
    run(of, request, info->client);
  } else if (info->kind == RR_REQUEST_GENERATOR) {
    rr_generator_handler handler = {0};
    counting* const count = make_context(sizeof *count);
    count->limit = unpack_int32(&info->arguments, "limit");
    count->sum = unpack_double(&info->arguments, "start");
    handler.size = sizeof handler;
    handler.context = count;
    handler.on_step = on_count;
    handler.drop = drop_context;
    rr_request_answer_generator(request, &handler, NULL);
  }
  rr_request_release(request);
}

static rr_object_type* board_type(void) {
  rr_member members[BOARD_MEMBERS];
  members[BOARD_SUM] = member("sum", RR_CALLBACK, 0, 1);
  members[BOARD_RUN] = member("run", RR_FUNCTION, 0, 1);
  members[BOARD_COUNT_TO] = member("count_to", RR_FUNCTION, 0, 1);
  members[BOARD_COUNT_TO].generator = RR_GENERATOR_RETURNS;
  members[BOARD_RUNNING_SUM] = member("running_sum", RR_FUNCTION, 0, 1);
  members[BOARD_RUNNING_SUM].generator = RR_GENERATOR_BOTH;
  members[BOARD_NOTE_DOWN] = member("note_down", RR_EVENT, 0, 0);
  return make_type(board_text, NULL, "Board", members, BOARD_MEMBERS, NULL);
}

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

static rr_served_object* make_plain(rr_object_type* type,
                                    void (*on_request)(void*, rr_request*,
                                                       const rr_request_info*)) {
  object* const of = make_context(sizeof *of);
  rr_object_handler handler = {0};
  handler.context = of;
  handler.on_request = on_request;
  of->self = make_object(type, &handler);
  return of->self;
}

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
  offered->objects[1] = make_plain(offered->types[1], on_board);
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
