/* SPDX-License-Identifier: Apache-2.0 */
#include <stdlib.h>
#include <string.h>

#include "service_parts.h"

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

rr_object_type* board_type(void) {
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

rr_served_object* make_board(rr_object_type* type) { return make_plain(type, on_board); }
