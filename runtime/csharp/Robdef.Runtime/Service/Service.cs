// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>How a service is offered.</summary>
public sealed record ServiceOptions
{
    /// <summary>What clients may ask about the service.</summary>
    public Dictionary<string, VarValue?>? Attributes { get; init; }

    /// <summary>Users with passwords, one a line, as docs/reference/c-abi.md says; empty: anybody, and no object can be locked.</summary>
    public string Users { get; init; } = "";

    /// <summary>With users: clients may connect without one.</summary>
    public bool UserIsOptional { get; init; }

    /// <summary>What each user may do, as rules (docs/howto/access.md). Null: everything; a text without rules allows nothing.</summary>
    public string? Rights { get; init; }

    /// <summary>The same in a file, instead of <see cref="Rights"/>; it is looked at every second. Empty: none.</summary>
    public string RightsFile { get; init; } = "";

    /// <summary>How long a client may have an object to itself without asking for anything; 30 s when not set.</summary>
    public TimeSpan? MonitorPatience { get; init; }

    /// <summary>Told of each client that has connected. On a thread of the node.</summary>
    public Action<ServedClient>? ClientConnected { get; init; }

    /// <summary>Told of each client whose session has ended. On a thread of the node.</summary>
    public Action<ServedClient>? ClientDisconnected { get; init; }

    /// <summary><see cref="NodeOptions.EnableDetailedErrors"/> for this service.</summary>
    public bool EnableDetailedErrors { get; init; }

    /// <summary>Definitions whose types may be in varvalues and varobjects, beside that of the root.</summary>
    public IReadOnlyList<ServiceDefinition> ExtraDefinitions { get; init; } = [];
}

/// <summary>A client of a service.</summary>
/// <param name="Client">The number by which members know it.</param>
/// <param name="Node">The id of its node.</param>
/// <param name="NodeName">The name of its node.</param>
/// <param name="User">Who is logged in; empty for nobody, and where it has just connected or left.</param>
public sealed record ServedClient(uint Client, Guid Node, string NodeName, string User);

/// <summary>A service that a node offers. Disposing it lets go of it; the service goes on until it is closed or the node ends.</summary>
public sealed class Service : IDisposable
{
    private readonly ServiceHandle _handle;

    internal Service(ServiceHandle handle) => _handle = handle;

    /// <summary>Its name.</summary>
    public string Name => Failure.Text(Functions.rr_service_name(_handle));

    /// <summary>Tells all clients that the service is closed, and ends their sessions. The name is free again.</summary>
    public void Close() => Functions.rr_service_close(_handle);

    /// <summary>Forgets the object at a path and those below, and tells the clients.</summary>
    public unsafe void ReleasePath(string path)
    {
        using var text = new NativeText(path);
        nint error;
        Failure.Check(Functions.rr_service_release_path(_handle, text.Value, 0, &error), error, KnownTypes.None);
    }

    /// <summary>Forgets the object of its own that one client has at a path, and those below.</summary>
    public unsafe void ReleasePath(string path, uint client)
    {
        using var text = new NativeText(path);
        nint error;
        Failure.Check(Functions.rr_service_release_path(_handle, text.Value, client, &error), error, KnownTypes.None);
    }

    /// <summary>What clients that ask from now on are told about the service.</summary>
    public unsafe void SetAttributes(Dictionary<string, VarValue?> attributes)
    {
        using var values = new NativeElements(attributes);
        RrElements native = values.Value;
        nint error;
        Failure.Check(Functions.rr_service_set_attributes(_handle, &native, &error), error, KnownTypes.None);
    }

    /// <summary>
    /// Other rights from now on, for sessions that are open, too: what they may not do any more ends. Null: everything.
    /// They hold until the file of rights changes, if there is one.
    /// </summary>
    /// <exception cref="InvalidConfigurationException">A rule is wrong; the message says where.</exception>
    public unsafe void SetRights(string? rights)
    {
        using var scope = new NativeScope();
        RrStr text = rights is null ? default : scope.Text(rights);
        nint error;
        Failure.Check(Functions.rr_service_set_rights(_handle, rights is null ? null : &text, &error), error, KnownTypes.None);
    }

    /// <summary>The clients that are connected now.</summary>
    public unsafe IReadOnlyList<ServedClient> GetClients()
    {
        var clients = new List<ServedClient>();
        var sink = new ClientSink(clients.Add);
        nint context = Context.Of(sink);
        try
        {
            nint error;
            Failure.Check(Functions.rr_service_clients(_handle, context, &ClientSink.OnConnected, &error), error, KnownTypes.None);
        }
        finally
        {
            Context.Free(context);
        }
        return clients;
    }

    /// <summary>Ends the session of a client, if it has one.</summary>
    public void Disconnect(uint client) => Functions.rr_service_disconnect(_handle, client);

    /// <summary>Lets go of the service, which goes on.</summary>
    public void Dispose() => _handle.Dispose();

    internal static unsafe Service Register(Node node, string name, Skeleton root, ServiceOptions options)
    {
        KnownTypes types = root.RrTypes;
        using var scope = new NativeScope();
        RrStr rights = options.Rights is null ? default : scope.Text(options.Rights);
        var extra = new nint[options.ExtraDefinitions.Count];
        for (int i = 0; i < extra.Length; ++i)
        {
            extra[i] = options.ExtraDefinitions[i].Handle.DangerousGetHandle();
        }
        nint error;
        nint users = 0;
        if (options.Users.Length != 0)
        {
            Failure.Check(Functions.rr_users_from_text(scope.Text(options.Users), out users, &error), error, types);
        }
        fixed (nint* definitions = extra)
        {
            var native = new RrServiceOptions
            {
                Size = (nuint)sizeof(RrServiceOptions),
                Attributes = scope.Map(options.Attributes),
                ExtraDefinitions = definitions,
                ExtraDefinitionCount = (nuint)extra.Length,
                Users = users,
                UserIsOptional = options.UserIsOptional ? 1u : 0,
                MonitorPatienceMs = options.MonitorPatience is { } patience ? Times.Milliseconds(patience) : 0,
                Context = Context.Of(new SessionsSink(name, node.Faults.With(options.EnableDetailedErrors), options)),
                OnClientConnected = &ClientSink.OnConnected,
                OnClientDisconnected = &ClientSink.OnDisconnected,
                OnClientLeaving = &ClientSink.OnLeaving,
                Drop = &Context.Drop,
                Rights = options.Rights is null ? null : &rights,
                RightsFile = scope.Text(options.RightsFile),
            };
            int status = Functions.rr_service_register(node.Handle, scope.Text(name), root.RrServe(), &native, out nint service, &error);
            if (users != 0)
            {
                Functions.rr_users_release(users);
            }
            Failure.Check(status, error, types);
            return new Service(new ServiceHandle(service));
        }
    }
}

/// <summary>Where the native runtime tells of a service's clients.</summary>
internal unsafe class ClientSink(Action<ServedClient>? connected)
{
    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnConnected(nint context, RrClientInfo* client) =>
        Tell(context, *client, static (sink, session, one) => sink.Connect(session, one));

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnDisconnected(nint context, RrClientInfo* client) =>
        Tell(context, *client, static (sink, session, one) => sink.Disconnect(session, one));

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnLeaving(nint context, RrClientInfo* client) => ServedSession.Leave(client->Session);

    protected virtual void Connect(ulong session, ServedClient client) => connected?.Invoke(client);

    protected virtual void Disconnect(ulong session, ServedClient client)
    {
    }

    private static void Tell(nint context, RrClientInfo client, Action<ClientSink, ulong, ServedClient> tell)
    {
        try
        {
            var node = new Guid(new ReadOnlySpan<byte>(client.Node.Bytes, 16), bigEndian: true);
            tell(Context.Get<ClientSink>(context), client.Session,
                new ServedClient(client.Client, node, Failure.Text(client.NodeName), Failure.Text(client.User)));
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }
}

/// <summary>Keeps what handlers know of the sessions of one service.</summary>
internal sealed class SessionsSink(string service, Faults faults, ServiceOptions options) : ClientSink(options.ClientConnected)
{
    protected override void Connect(ulong session, ServedClient client)
    {
        ServedSession.Begin(session, service, faults);
        base.Connect(session, client);
    }

    protected override void Disconnect(ulong session, ServedClient client)
    {
        ServedSession.End(session);
        options.ClientDisconnected?.Invoke(client);
    }
}
