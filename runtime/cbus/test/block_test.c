/* SPDX-License-Identifier: Apache-2.0
 * Runs a generated block with the stand-in: frames out of one, into the other. */
#include <stdio.h>
#include <stdlib.h>

#include "experimental_arm_Command_sfun.c"

static void check(int claim, const char* text) {
  if (claim) return;
  fprintf(stderr, "block_test: not so: %s\n", text);
  exit(1);
}

void ssSetNumSFcnParams(SimStruct* S, int count) { S->parameter_count = count; }
int ssGetNumSFcnParams(SimStruct* S) { return S->parameter_count; }
int ssGetSFcnParamsCount(SimStruct* S) { return S == NULL ? 0 : 1; }
void ssSetSFcnParamTunable(SimStruct* S, int index, int is_tunable) {
  check(S != NULL && index == 0 && !is_tunable, "the parameter stays as it is");
}
const mxArray* ssGetSFcnParam(SimStruct* S, int index) {
  check(index == 0, "there is one parameter");
  return &S->parameter;
}
double mxGetScalar(const mxArray* array) { return array->value; }
void ssRegisterTypeFromNamedObject(SimStruct* S, const char* name, DTypeId* type) {
  *type = S->bus != NULL && strcmp(S->bus, name) == 0 ? STAND_IN_FIRST_BUS : INVALID_DTYPE_ID;
}
void ssSetErrorStatus(SimStruct* S, const char* text) { S->error = text; }
int ssSetNumInputPorts(SimStruct* S, int count) {
  S->input_count = count;
  return count <= STAND_IN_PORTS;
}
int ssSetNumOutputPorts(SimStruct* S, int count) {
  S->output_count = count;
  return count <= STAND_IN_PORTS;
}
void ssSetInputPortDirectFeedThrough(SimStruct* S, int port, int is_direct) {
  check(port < S->input_count && is_direct, "outputs follow inputs at once");
}
void ssSetInputPortRequiredContiguous(SimStruct* S, int port, int is_contiguous) {
  S->inputs[port].is_contiguous = is_contiguous;
}
void ssSetInputPortWidth(SimStruct* S, int port, int width) { S->inputs[port].width = width; }
void ssSetOutputPortWidth(SimStruct* S, int port, int width) { S->outputs[port].width = width; }
void ssSetInputPortDataType(SimStruct* S, int port, DTypeId type) { S->inputs[port].type = type; }
void ssSetOutputPortDataType(SimStruct* S, int port, DTypeId type) { S->outputs[port].type = type; }
void ssSetBusInputAsStruct(SimStruct* S, int port, int is_struct) {
  S->inputs[port].is_bus = is_struct;
}
void ssSetBusOutputAsStruct(SimStruct* S, int port, int is_struct) {
  S->outputs[port].is_bus = is_struct;
}
void ssSetBusOutputObjectName(SimStruct* S, int port, void* name) {
  check(port == 0 && strcmp((const char*)name, S->bus) == 0, "the bus has its object's name");
}
void ssSetNumSampleTimes(SimStruct* S, int count) { check(S != NULL && count == 1, "one rate"); }
void ssSetSampleTime(SimStruct* S, int index, double time) {
  check(index == 0, "one rate");
  S->sample_time = time;
}
void ssSetOffsetTime(SimStruct* S, int index, double time) {
  check(S != NULL && index == 0 && !(time > 0), "no offset");
}
void ssSetNumDWork(SimStruct* S, int count) { S->work_count = count; }
void ssSetDWorkWidth(SimStruct* S, int index, int width) {
  check(index < S->work_count, "there is such a work vector");
  S->work_width = width;
}
void ssSetDWorkDataType(SimStruct* S, int index, DTypeId type) {
  check(index < S->work_count, "there is such a work vector");
  S->work_type = type;
}
void* ssGetDWork(SimStruct* S, int index) {
  check(index == 0, "there is one work vector");
  return S->work;
}
const void* ssGetInputPortSignal(SimStruct* S, int port) {
  check(S->inputs[port].is_contiguous, "contiguous inputs are asked for as such");
  return S->inputs[port].signal;
}
void* ssGetOutputPortSignal(SimStruct* S, int port) { return S->outputs[port].signal; }
double ssGetT(SimStruct* S) { return S->time; }

static void start(SimStruct* block, double takes_frames) {
  memset(block, 0, sizeof *block);
  block->bus = "experimental_arm_Command";
  block->parameter.value = takes_frames;
  mdlInitializeSizes(block);
  mdlInitializeSampleTimes(block);
  check(block->error == NULL, "the block has no error");
  check(block->sample_time < 0, "the rate is inherited");
  check(block->work_count == 1 && block->work_type == SS_UINT8, "it remembers in bytes");
  block->work = malloc((size_t)block->work_width);
  mdlStart(block);
}

int main(void) {
  SimStruct sender;
  SimStruct receiver;
  SimStruct none;
  experimental_arm_Command sent = {0};
  experimental_arm_Command received;
  uint8_t frame[experimental_arm_Command_FRAME_BYTES];
  boolean_T is_newer = 0;

  start(&sender, 0);
  check(sender.inputs[0].is_bus && sender.inputs[0].type == STAND_IN_FIRST_BUS, "a bus goes in");
  check(sender.outputs[0].width == (int)sizeof frame, "a frame comes out");
  start(&receiver, 1);
  check(receiver.inputs[0].width == (int)sizeof frame, "a frame goes in");
  check(receiver.output_count == 2 && receiver.outputs[0].is_bus, "a bus comes out");

  sent.mode = 7;
  sent.target[5] = -1.5;
  sender.inputs[0].signal = &sent;
  sender.outputs[0].signal = frame;
  sender.time = 0.25;
  mdlOutputs(&sender, 0);
  receiver.inputs[0].signal = frame;
  receiver.outputs[0].signal = &received;
  receiver.outputs[1].signal = &is_newer;
  mdlOutputs(&receiver, 0);
  check(is_newer == 1 && received.mode == 7 && received.target[5] < -1, "the bus arrives");
  mdlOutputs(&receiver, 0);
  check(is_newer == 0 && received.mode == 7, "the same frame is no newer, and the bus stays");
  sent.mode = 8;
  mdlOutputs(&sender, 0);
  frame[60] ^= 1;
  mdlOutputs(&receiver, 0);
  check(is_newer == 0 && received.mode == 7, "a damaged frame changes nothing");
  frame[60] ^= 1;
  mdlOutputs(&receiver, 0);
  check(is_newer == 1 && received.mode == 8, "the next frame is newer");
  mdlTerminate(&sender);
  mdlTerminate(&receiver);
  free(sender.work);
  free(receiver.work);

  memset(&none, 0, sizeof none);
  mdlInitializeSizes(&none);
  check(none.error != NULL, "without its bus object the block says so");
  puts("block: passed");
  return 0;
}
