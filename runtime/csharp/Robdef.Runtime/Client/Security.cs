// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>
/// Certificates of a node, and whom it trusts (docs/explanation/security.md). Files are looked at again while the node runs.
/// </summary>
public sealed record TlsOptions
{
    /// <summary>The node's certificate, PEM or .p12, of which it takes its id; empty: none.</summary>
    public string CertificateFile { get; init; } = "";

    /// <summary>The key, PEM; empty: in the file of the certificate.</summary>
    public string KeyFile { get; init; } = "";

    /// <summary>Certificates of authorities that are trusted, besides those that the environment names.</summary>
    public IReadOnlyList<string> AuthorityFiles { get; init; } = [];

    /// <summary>Lists of certificates that authorities have revoked.</summary>
    public IReadOnlyList<string> RevocationFiles { get; init; } = [];

    /// <summary>Nodes that are trusted for one certificate alone: its SHA-256 as 64 hexadecimal digits.</summary>
    public IReadOnlyDictionary<Guid, string> Pins { get; init; } = new Dictionary<Guid, string>();

    /// <summary>Nothing but TLS, in both directions. Local connections are excepted.</summary>
    public bool IsRequired { get; init; }

    /// <summary>Clients that use TLS have to prove which node they are.</summary>
    public bool MustCertifyClients { get; init; }

    /// <summary>Whether the system's authorities prove hosts of rr+wss; when not set, only where no authority file is given.</summary>
    public bool? TrustSystemAuthorities { get; init; }

    /// <summary>Lists of revoked certificates that have run out are used all the same.</summary>
    public bool AcceptsOutdatedLists { get; init; }

    /// <summary>How often files are looked at besides at new connections; 5 s when not set, never when zero.</summary>
    public TimeSpan? LookAgainPeriod { get; init; }
}

/// <summary>A record of who connects, logs in and is refused, as lines of JSON (docs/howto/access.md).</summary>
public sealed record AuditOptions
{
    /// <summary>Gets the lines; nobody but its owner may read it. Empty: no file.</summary>
    public string File { get; init; } = "";

    /// <summary>Gets each line. On any thread, for several events at once.</summary>
    public Action<string>? Event { get; init; }

    /// <summary>Requests that were handled are told, too, and not only refused ones.</summary>
    public bool Requests { get; init; }

    /// <summary>Refusals of a session that are told in ten seconds; others are counted. 50 when zero.</summary>
    public int Refusals { get; init; }

    /// <summary>A file that would become larger, in bytes, is renamed; 16 MiB when zero.</summary>
    public long MaxFileSize { get; init; }

    /// <summary>How many renamed files are kept; five when zero.</summary>
    public int KeptFiles { get; init; }
}

/// <summary>The native form of both, valid as long as the scope.</summary>
internal static unsafe class SecurityTerms
{
    public static RrTlsOptions* Of(TlsOptions? options, NativeScope scope)
    {
        if (options is null)
        {
            return null;
        }
        RrTlsOptions* native = scope.New<RrTlsOptions>(1);
        native->Size = (nuint)sizeof(RrTlsOptions);
        native->CertificateFile = scope.Text(options.CertificateFile);
        native->KeyFile = scope.Text(options.KeyFile);
        native->AuthorityFiles = scope.Texts(options.AuthorityFiles, out native->AuthorityFileCount);
        native->RevocationFiles = scope.Texts(options.RevocationFiles, out native->RevocationFileCount);
        native->Pins = scope.New<RrPin>(options.Pins.Count);
        foreach ((Guid node, string sha256) in options.Pins)
        {
            native->Pins[native->PinCount++] = new RrPin { Node = Copies.Id(node), Sha256 = scope.Text(sha256) };
        }
        native->IsRequired = options.IsRequired ? 1u : 0;
        native->MustCertifyClients = options.MustCertifyClients ? 1u : 0;
        native->SystemAuthorities = options.TrustSystemAuthorities switch { null => 0, true => 1, false => 2 };
        native->AcceptsOutdatedLists = options.AcceptsOutdatedLists ? 1u : 0;
        native->LookAgainPeriodMs = options.LookAgainPeriod switch
        {
            null => 0,
            { Ticks: 0 } => -1,
            { } period => Times.Milliseconds(period),
        };
        return native;
    }

    public static RrAuditOptions* Of(AuditOptions? options, NativeScope scope)
    {
        if (options is null)
        {
            return null;
        }
        ArgumentOutOfRangeException.ThrowIfNegative(options.Refusals);
        ArgumentOutOfRangeException.ThrowIfNegative(options.MaxFileSize);
        ArgumentOutOfRangeException.ThrowIfNegative(options.KeptFiles);
        RrAuditOptions* native = scope.New<RrAuditOptions>(1);
        native->Size = (nuint)sizeof(RrAuditOptions);
        native->File = scope.Text(options.File);
        native->MaxSize = (ulong)options.MaxFileSize;
        native->KeptFiles = (uint)options.KeptFiles;
        native->Requests = options.Requests ? 1u : 0;
        native->Refusals = (ulong)options.Refusals;
        if (options.Event is { } tell)
        {
            native->Context = Context.Of(new AuditSink(tell));
            native->OnEvent = &AuditSink.OnEvent;
            native->Drop = &Context.Drop;
        }
        return native;
    }
}

/// <summary>Where the native runtime tells what clients do.</summary>
internal sealed unsafe class AuditSink(Action<string> tell)
{
    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnEvent(nint context, RrStr line)
    {
        try
        {
            Context.Get<AuditSink>(context).Tell(Failure.Text(line));
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }

    private void Tell(string line) => tell(line);
}
