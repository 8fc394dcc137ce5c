// SPDX-License-Identifier: Apache-2.0
using System.Runtime.InteropServices;

namespace Robdef.Runtime.Native;

#pragma warning disable IDE1006, CA1707 // Names as in rr.h.
/// <summary>The functions of rr.h that are used. What they do and own is said there.</summary>
internal static unsafe partial class Functions
{
    private const string Library = "robdef_c";
    private const uint Version = 0x00010005;

    static Functions()
    {
        uint version = rr_abi_version();
        if (version >> 16 != Version >> 16 || version < Version)
        {
            throw new InvalidConfigurationException(
                $"the native library has version {version >> 16}.{version & 0xFFFF}, and {Version >> 16}.{Version & 0xFFFF} is needed");
        }
    }

    [LibraryImport(Library)]
    public static partial uint rr_abi_version();

    [LibraryImport(Library)]
    public static partial RrElements rr_data_elements(nint data);
    [LibraryImport(Library)]
    public static partial void rr_data_release(nint data);
    [LibraryImport(Library)]
    public static partial void rr_error_read(nint error, RrErrorInfo* info);
    [LibraryImport(Library)]
    public static partial void rr_error_release(nint error);

    [LibraryImport(Library)]
    public static partial int rr_cancellation_new(out nint cancellation, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_cancellation_cancel(nint cancellation);
    [LibraryImport(Library)]
    public static partial void rr_cancellation_release(nint cancellation);
    [LibraryImport(Library)]
    public static partial void rr_subscription_release(nint subscription);

    [LibraryImport(Library)]
    public static partial int rr_request_answer(nint request, RrElements* value, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_request_answer_end(nint request, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_request_fail(nint request, RrErrorInfo* why, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_request_release(nint request);
    [LibraryImport(Library)]
    public static partial void rr_request_read(nint request, RrRequestInfo* info);
    [LibraryImport(Library)]
    public static partial int rr_request_answer_object(nint request, SafeHandle served, int perClient, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_request_answer_generator(nint request, RrGeneratorHandler* handler, nint* error);

    [LibraryImport(Library)]
    public static partial int rr_node_new(RrNodeOptions* options, out nint node, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_node_release(nint node);
    [LibraryImport(Library)]
    public static partial void rr_node_shutdown(SafeHandle node);
    [LibraryImport(Library)]
    public static partial int rr_node_listen(SafeHandle node, RrStr url, out ushort port, nint* error);
    [LibraryImport(Library)]
    public static partial RrNodeId rr_node_get_id(SafeHandle node);
    [LibraryImport(Library)]
    public static partial int rr_client_connect(SafeHandle node, RrStr* urls, nuint count, RrConnectOptions* options, out nint client, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_client_connect_async(SafeHandle node, RrStr* urls, nuint count, RrConnectOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_client_release(nint client);
    [LibraryImport(Library)]
    public static partial void rr_client_close(SafeHandle client);
    [LibraryImport(Library)]
    public static partial int rr_client_is_open(SafeHandle client);
    [LibraryImport(Library)]
    public static partial void rr_client_cancel_calls(SafeHandle client);
    [LibraryImport(Library)]
    public static partial RrNodeId rr_client_remote_node(SafeHandle client);
    [LibraryImport(Library)]
    public static partial RrStr rr_client_remote_name(SafeHandle client);
    [LibraryImport(Library)]
    public static partial int rr_client_attributes(SafeHandle client, out nint data, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_client_fetch_attributes(SafeHandle client, out nint data, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_client_authenticate(SafeHandle client, RrStr user, RrStr password, RrElements* credentials, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_client_logout(SafeHandle client, nint* error);
    [LibraryImport(Library)]
    public static partial uint rr_client_message_version(SafeHandle client);
    [LibraryImport(Library)]
    public static partial int rr_client_root(SafeHandle client, out nint root, nint* error);

    [LibraryImport(Library)]
    public static partial void rr_object_release(nint handle);
    [LibraryImport(Library)]
    public static partial RrStr rr_object_path(SafeHandle handle);
    [LibraryImport(Library)]
    public static partial RrStr rr_object_type_name(SafeHandle handle);
    [LibraryImport(Library)]
    public static partial int rr_object_find(SafeHandle handle, RrStr member, RrIndex* index, RrStr type, RrCallOptions* options, out nint found, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_object_find_async(SafeHandle handle, RrStr member, RrIndex* index, RrStr type, RrCallOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_object_call(SafeHandle handle, uint request, RrStr member, RrElements* elements, RrCallOptions* options, out nint answer, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_object_call_async(SafeHandle handle, uint request, RrStr member, RrElements* elements, RrCallOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_object_find_type(SafeHandle handle, RrStr member, RrIndex* index, RrCallOptions* options, out nint data, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_object_lock(SafeHandle handle, int sessionOnly, RrCallOptions* options, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_object_unlock(SafeHandle handle, RrCallOptions* options, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_object_enter_monitor(SafeHandle handle, int waitMs, RrCallOptions* options, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_object_exit_monitor(SafeHandle handle, RrCallOptions* options, nint* error);

    [LibraryImport(Library)]
    public static partial int rr_event_subscribe(SafeHandle handle, RrStr member, RrEventHandler* handler, out nint subscription, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_callback_set(SafeHandle handle, RrStr member, uint access, int returnsValue, RrCallbackHandler* handler, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_callback_clear(SafeHandle handle, RrStr member, nint* error);

    [LibraryImport(Library)]
    public static partial int rr_generator_open(SafeHandle handle, RrStr member, RrElements* arguments, RrCallOptions* options, out nint generator, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_generator_open_async(SafeHandle handle, RrStr member, RrElements* arguments, RrCallOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_generator_next(SafeHandle generator, RrElements* parameter, RrCallOptions* options, out nint value, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_generator_next_async(SafeHandle generator, RrElements* parameter, RrCallOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_generator_end(SafeHandle generator, int aborts, RrCallOptions* options, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_generator_end_async(SafeHandle generator, int aborts, RrCallOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_generator_release(nint generator);

    [LibraryImport(Library)]
    public static partial int rr_memory_read(SafeHandle handle, RrStr member, RrMemoryType* type, ulong* position, ulong* count, nuint dims, void* items, nuint size, RrCallOptions* options, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_memory_write(SafeHandle handle, RrStr member, RrMemoryType* type, ulong* position, ulong* count, nuint dims, void* items, nuint size, RrCallOptions* options, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_memory_read_async(SafeHandle handle, RrStr member, RrMemoryType* type, ulong* position, ulong* count, nuint dims, void* items, nuint size, RrCallOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_memory_write_async(SafeHandle handle, RrStr member, RrMemoryType* type, ulong* position, ulong* count, nuint dims, void* items, nuint size, RrCallOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_memory_read_pieces(SafeHandle handle, RrStr member, RrMemoryType* type, ulong* position, ulong* count, nuint dims, RrMemoryPieces* pieces, RrCallOptions* options, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_memory_write_pieces(SafeHandle handle, RrStr member, RrMemoryType* type, ulong* position, ulong* count, nuint dims, RrMemoryPieces* pieces, RrCallOptions* options, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_memory_read_pieces_async(SafeHandle remote, RrStr member, RrMemoryType* type, ulong* position, ulong* count,
        nuint dims, RrMemoryPieces* pieces, RrCallOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_memory_write_pieces_async(SafeHandle remote, RrStr member, RrMemoryType* type, ulong* position, ulong* count,
        nuint dims, RrMemoryPieces* pieces, RrCallOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_piece_set(nint piece, RrElements* data, nint* error);

    [LibraryImport(Library)]
    public static partial int rr_pipe_connect_async(SafeHandle handle, RrStr member, RrPipeOptions* pipe, RrCallOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_pipe_connect(SafeHandle handle, RrStr member, RrPipeOptions* pipe, RrCallOptions* options, out nint end, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_pipe_release(nint pipe);
    [LibraryImport(Library)]
    public static partial void rr_pipe_close(SafeHandle pipe);
    [LibraryImport(Library)]
    public static partial int rr_pipe_is_open(SafeHandle pipe);
    [LibraryImport(Library)]
    public static partial int rr_pipe_index(SafeHandle pipe);
    [LibraryImport(Library)]
    public static partial int rr_pipe_is_unreliable(SafeHandle pipe);
    [LibraryImport(Library)]
    public static partial uint rr_pipe_client(SafeHandle pipe);
    [LibraryImport(Library)]
    public static partial int rr_pipe_send(SafeHandle pipe, RrElements* packet, uint* number, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_pipe_receive(SafeHandle pipe, out nint packet, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_pipe_peek(SafeHandle pipe, out nint packet, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_pipe_wait(SafeHandle pipe, int timeoutMs);
    [LibraryImport(Library)]
    public static partial int rr_pipe_receive_within_async(SafeHandle pipe, RrCallOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial nuint rr_pipe_available(SafeHandle pipe);
    [LibraryImport(Library)]
    public static partial void rr_pipe_ask_for_acknowledgements(SafeHandle pipe, int on);
    [LibraryImport(Library)]
    public static partial nuint rr_pipe_unacknowledged(SafeHandle pipe);
    [LibraryImport(Library)]
    public static partial int rr_pipe_set_handler(SafeHandle pipe, RrPipeHandler* handler, nint* error);

    [LibraryImport(Library)]
    public static partial int rr_wire_connect(SafeHandle handle, RrStr member, uint access, RrCallOptions* options, out nint wire, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_connect_async(SafeHandle handle, RrStr member, uint access, RrCallOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_wire_release(nint wire);
    [LibraryImport(Library)]
    public static partial void rr_wire_close(SafeHandle wire);
    [LibraryImport(Library)]
    public static partial int rr_wire_is_open(SafeHandle wire);
    [LibraryImport(Library)]
    public static partial uint rr_wire_client(SafeHandle wire);
    [LibraryImport(Library)]
    public static partial int rr_wire_send(SafeHandle wire, RrElements* value, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_received(SafeHandle wire, out nint value, RrTime* time, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_sent(SafeHandle wire, out nint value, RrTime* time, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_wait(SafeHandle wire, int timeoutMs);
    [LibraryImport(Library)]
    public static partial void rr_wire_set_lifespan(SafeHandle wire, int lifespanMs);
    [LibraryImport(Library)]
    public static partial int rr_wire_set_handler(SafeHandle wire, RrWireHandler* handler, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_peek_in(SafeHandle handle, RrStr member, RrCallOptions* options, out nint value, RrTime* time, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_peek_out(SafeHandle handle, RrStr member, RrCallOptions* options, out nint value, RrTime* time, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_poke_out(SafeHandle handle, RrStr member, RrElements* value, RrCallOptions* options, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_peek_in_async(SafeHandle handle, RrStr member, RrCallOptions* options, RrTime* time, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_peek_out_async(SafeHandle handle, RrStr member, RrCallOptions* options, RrTime* time, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_poke_out_async(SafeHandle handle, RrStr member, RrElements* value, RrCallOptions* options, RrCompletion* completion, nint* error);

    [LibraryImport(Library)]
    public static partial int rr_service_subscribe(SafeHandle node, RrStr* urls, nuint count, RrSubscribeOptions* options, out nint subscription, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_service_subscribe_all(SafeHandle node, RrServiceUrls* services, nuint count, RrSubscribeOptions* options, out nint subscription, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_service_subscribe_types(SafeHandle node, RrStr* types, nuint count, RrSubscribeOptions* options, out nint subscription, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_service_subscription_update_services(SafeHandle subscription, RrServiceUrls* services, nuint count, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_service_subscription_update_types(SafeHandle subscription, RrStr* types, nuint count, RrServiceFilter* filter, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_service_subscription_watch(SafeHandle subscription, RrServiceSubscriptionHandler* handler, out nint watch, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_service_subscription_clients(SafeHandle subscription, nint context, delegate* unmanaged[Cdecl]<nint, RrSubscribedClient*, void> each, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_service_subscription_client_root(SafeHandle subscription, RrSubscribedClient* client, out nint root, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_service_subscription_services(SafeHandle subscription, nint context, delegate* unmanaged[Cdecl]<nint, RrSubscribedService*, void> each, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_service_subscription_release(nint subscription);
    [LibraryImport(Library)]
    public static partial void rr_service_subscription_close(SafeHandle subscription);
    [LibraryImport(Library)]
    public static partial int rr_service_subscription_is_open(SafeHandle subscription);
    [LibraryImport(Library)]
    public static partial int rr_service_subscription_root(SafeHandle subscription, int waitMs, out nint root, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_subscribe(SafeHandle subscription, RrStr member, RrStr path, out nint wire, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_wire_subscription_release(nint wire);
    [LibraryImport(Library)]
    public static partial void rr_wire_subscription_close(SafeHandle wire);
    [LibraryImport(Library)]
    public static partial int rr_wire_subscription_send(SafeHandle wire, RrElements* value, nuint* count, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_subscription_received(SafeHandle wire, out nint value, RrTime* time, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_subscription_newest(SafeHandle wire, nint context, delegate* unmanaged[Cdecl]<nint, RrSubscribedClient*, RrElements*, RrTime*, nint, void> each, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_subscription_values(SafeHandle wire, nint context, delegate* unmanaged[Cdecl]<nint, RrSubscribedClient*, RrElements*, RrTime*, nint, void> each, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_subscription_clients(SafeHandle wire, nint context, delegate* unmanaged[Cdecl]<nint, RrSubscribedClient*, void> each, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_subscription_set_lifespan(SafeHandle wire, int lifespanMs, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_wire_subscription_wait(SafeHandle wire, int timeoutMs);
    [LibraryImport(Library)]
    public static partial int rr_wire_subscription_set_handler(SafeHandle wire, RrSubscriptionHandler* handler, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_pipe_subscribe(SafeHandle subscription, RrStr member, RrStr path, nuint maxReceived, out nint pipe, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_pipe_subscription_release(nint pipe);
    [LibraryImport(Library)]
    public static partial void rr_pipe_subscription_close(SafeHandle pipe);
    [LibraryImport(Library)]
    public static partial int rr_pipe_subscription_send(SafeHandle pipe, RrElements* packet, nuint* count, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_pipe_subscription_receive(SafeHandle pipe, out nint packet, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_pipe_subscription_take(SafeHandle pipe, nint context, delegate* unmanaged[Cdecl]<nint, RrSubscribedClient*, RrElements*, nint, void> each, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_pipe_subscription_clients(SafeHandle pipe, nint context, delegate* unmanaged[Cdecl]<nint, RrSubscribedClient*, void> each, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_pipe_subscription_wait(SafeHandle pipe, int timeoutMs);
    [LibraryImport(Library)]
    public static partial int rr_pipe_subscription_set_handler(SafeHandle pipe, RrSubscriptionHandler* handler, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_object_subscribe(SafeHandle subscription, RrStr path, out nint found, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_object_subscription_release(nint found);
    [LibraryImport(Library)]
    public static partial void rr_object_subscription_close(SafeHandle found);
    [LibraryImport(Library)]
    public static partial int rr_object_subscription_get(SafeHandle found, int waitMs, out nint remote, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_service_info_subscribe(SafeHandle node, RrStr* types, nuint count, RrServiceFilter* filter, RrServiceInfoHandler* handler, out nint subscription, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_service_info_subscription_release(nint subscription);
    [LibraryImport(Library)]
    public static partial void rr_service_info_subscription_close(SafeHandle subscription);
    [LibraryImport(Library)]
    public static partial int rr_service_info_subscription_is_open(SafeHandle subscription);
    [LibraryImport(Library)]
    public static partial int rr_service_info_subscription_services(SafeHandle subscription, out nint services, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_service_info_subscription_watch(SafeHandle subscription, RrServiceInfoHandler* handler, out nint watch, nint* error);

    [LibraryImport(Library)]
    public static partial int rr_discovery_announce(SafeHandle node, RrAnnounceOptions* options, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_discovery_stop_announcing(SafeHandle node);
    [LibraryImport(Library)]
    public static partial int rr_discovery_listen(SafeHandle node, RrListenOptions* options, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_discovery_stop_listening(SafeHandle node);
    [LibraryImport(Library)]
    public static partial int rr_discovery_is_listening(SafeHandle node);
    [LibraryImport(Library)]
    public static partial int rr_discovery_request(SafeHandle node, nint* error);
    [LibraryImport(Library)]
    public static partial nuint rr_detected_nodes_count(nint nodes);
    [LibraryImport(Library)]
    public static partial int rr_detected_nodes_read(nint nodes, nuint place, RrDetectedNode* info, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_detected_nodes_release(nint nodes);
    [LibraryImport(Library)]
    public static partial nuint rr_found_services_count(nint services);
    [LibraryImport(Library)]
    public static partial int rr_found_services_read(nint services, nuint place, RrFoundService* info, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_found_services_release(nint services);
    [LibraryImport(Library)]
    public static partial int rr_discovery_nodes(SafeHandle node, out nint nodes, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_discovery_watch(SafeHandle node, RrDiscoveryHandler* handler, out nint watch, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_discovery_find_services(SafeHandle node, RrStr* types, nuint count, RrFindOptions* options, out nint services, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_discovery_find_node(SafeHandle node, RrNodeId id, RrFindOptions* options, out nint nodes, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_discovery_find_nodes(SafeHandle node, RrStr name, RrFindOptions* options, out nint nodes, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_discovery_update_nodes(SafeHandle node, RrFindOptions* options, out nint nodes, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_discovery_find_services_async(SafeHandle node, RrStr* types, nuint count, RrFindOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_discovery_find_node_async(SafeHandle node, RrNodeId id, RrFindOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_discovery_find_nodes_async(SafeHandle node, RrStr name, RrFindOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_discovery_update_nodes_async(SafeHandle node, RrFindOptions* options, RrCompletion* completion, nint* error);

    [LibraryImport(Library)]
    public static partial int rr_definition_new(RrStr text, nint* imports, nuint count, out nint definition, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_definition_release(nint definition);
    [LibraryImport(Library)]
    public static partial int rr_object_type_new(SafeHandle definition, RrStr name, RrMember* members, nuint count, nuint memberSize, out nint type, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_object_type_release(nint type);
    [LibraryImport(Library)]
    public static partial int rr_served_object_new(SafeHandle type, RrObjectHandler* handler, out nint served, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_served_object_release(nint served);
    [LibraryImport(Library)]
    public static partial int rr_served_event_fire(SafeHandle served, uint member, RrElements* arguments, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_served_callback_call(SafeHandle served, uint member, uint client, RrElements* arguments, RrCallOptions* options, out nint answer, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_served_callback_call_async(SafeHandle served, uint member, uint client, RrElements* arguments, RrCallOptions* options, RrCompletion* completion, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_served_pipe_set_handler(SafeHandle served, uint member, RrServedPipeHandler* handler, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_served_pipe_send(SafeHandle served, uint member, RrElements* packet, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_served_pipe_endpoints(SafeHandle served, uint member, nint* pipes, nuint* count, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_served_pipe_set_backlog_limit(SafeHandle served, uint member, nuint packets, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_served_wire_connections(SafeHandle served, uint member, nint* wires, nuint* count, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_served_wire_set_lifespan(SafeHandle served, uint member, int lifespanMs, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_served_wire_set_handler(SafeHandle served, uint member, RrServedWireHandler* handler, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_served_wire_send(SafeHandle served, uint member, RrElements* value, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_served_wire_received(SafeHandle served, uint member, out nint value, RrTime* time, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_served_memory_set(SafeHandle served, uint member, RrMemorySource* source, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_users_from_text(RrStr text, out nint users, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_users_release(nint users);
    [LibraryImport(Library)]
    public static partial int rr_service_register(SafeHandle node, RrStr name, SafeHandle root, RrServiceOptions* options, out nint service, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_service_release(nint service);
    [LibraryImport(Library)]
    public static partial void rr_service_close(SafeHandle service);
    [LibraryImport(Library)]
    public static partial int rr_service_release_path(SafeHandle service, RrStr path, uint client, nint* error);
    [LibraryImport(Library)]
    public static partial RrStr rr_service_name(SafeHandle service);
    [LibraryImport(Library)]
    public static partial int rr_service_set_attributes(SafeHandle service, RrElements* attributes, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_service_set_rights(SafeHandle service, RrStr* rights, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_service_clients(SafeHandle service, nint context, delegate* unmanaged[Cdecl]<nint, RrClientInfo*, void> each, nint* error);
    [LibraryImport(Library)]
    public static partial void rr_service_disconnect(SafeHandle service, uint client);
    [LibraryImport(Library)]
    public static partial uint rr_current_client();
    [LibraryImport(Library)]
    public static partial int rr_current_user(out nint name, nint* error);
    [LibraryImport(Library)]
    public static partial int rr_current_user_has(RrStr privilege);
}
#pragma warning restore IDE1006, CA1707
