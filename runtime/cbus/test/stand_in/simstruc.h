/* SPDX-License-Identifier: Apache-2.0
 *
 * Stands in for the header of Simulink of the same name, as far as generated blocks use it: names and
 * parameters as users of Simulink write them, everything else our own. A block that compiles and runs
 * here has not been tried in Simulink.
 */
#ifndef SIMSTRUC_STAND_IN_H
#define SIMSTRUC_STAND_IN_H

#include <stddef.h>

typedef int int_T;
typedef unsigned char boolean_T;
typedef double real_T;
typedef int DTypeId;
typedef struct {
  double value;
} mxArray;

enum { SS_UINT8 = 3, SS_BOOLEAN = 8, STAND_IN_FIRST_BUS = 100, STAND_IN_PORTS = 2 };
#define INVALID_DTYPE_ID (-10)
#define INHERITED_SAMPLE_TIME (-1.0)

typedef struct {
  int width;
  DTypeId type;
  int is_bus;
  int is_contiguous;
  void* signal;
} stand_in_port;

typedef struct {
  const char* bus; /* the one that is known */
  const char* error;
  mxArray parameter;
  int parameter_count;
  int input_count;
  int output_count;
  stand_in_port inputs[STAND_IN_PORTS];
  stand_in_port outputs[STAND_IN_PORTS];
  int work_count;
  int work_width;
  DTypeId work_type;
  void* work;
  double sample_time;
  double time;
} SimStruct;

void ssSetNumSFcnParams(SimStruct* S, int count);
int ssGetNumSFcnParams(SimStruct* S);
int ssGetSFcnParamsCount(SimStruct* S);
void ssSetSFcnParamTunable(SimStruct* S, int index, int is_tunable);
const mxArray* ssGetSFcnParam(SimStruct* S, int index);
double mxGetScalar(const mxArray* array);
void ssRegisterTypeFromNamedObject(SimStruct* S, const char* name, DTypeId* type);
void ssSetErrorStatus(SimStruct* S, const char* text);
int ssSetNumInputPorts(SimStruct* S, int count);
int ssSetNumOutputPorts(SimStruct* S, int count);
void ssSetInputPortDirectFeedThrough(SimStruct* S, int port, int is_direct);
void ssSetInputPortRequiredContiguous(SimStruct* S, int port, int is_contiguous);
void ssSetInputPortWidth(SimStruct* S, int port, int width);
void ssSetOutputPortWidth(SimStruct* S, int port, int width);
void ssSetInputPortDataType(SimStruct* S, int port, DTypeId type);
void ssSetOutputPortDataType(SimStruct* S, int port, DTypeId type);
void ssSetBusInputAsStruct(SimStruct* S, int port, int is_struct);
void ssSetBusOutputAsStruct(SimStruct* S, int port, int is_struct);
void ssSetBusOutputObjectName(SimStruct* S, int port, void* name);
void ssSetNumSampleTimes(SimStruct* S, int count);
void ssSetSampleTime(SimStruct* S, int index, double time);
void ssSetOffsetTime(SimStruct* S, int index, double time);
void ssSetNumDWork(SimStruct* S, int count);
void ssSetDWorkWidth(SimStruct* S, int index, int width);
void ssSetDWorkDataType(SimStruct* S, int index, DTypeId type);
void* ssGetDWork(SimStruct* S, int index);
const void* ssGetInputPortSignal(SimStruct* S, int port);
void* ssGetOutputPortSignal(SimStruct* S, int port);
double ssGetT(SimStruct* S);

#endif
