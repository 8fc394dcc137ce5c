// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Threading;
using System.Threading.Tasks;
using Microsoft.Extensions.Hosting;
using Microsoft.Extensions.Logging;
using Microsoft.Extensions.Options;
using Robdef.Runtime;

namespace Robdef.Hosting;

/// <summary>What the node of a host offers under a name.</summary>
internal sealed record OfferedService(string Name, Func<IServiceProvider, Skeleton> Root, Func<IServiceProvider, ServiceOptions> Options);

/// <summary>Makes the node when the host starts, and shuts it down when it stops.</summary>
internal sealed partial class RobdefNodeService(
    IOptions<RobdefNodeSettings> settings,
    IEnumerable<OfferedService> services,
    IServiceProvider provider,
    RobdefHost host,
    ILoggerFactory loggers) : IHostedService, IDisposable
{
    private readonly ILogger _logger = loggers.CreateLogger("Robdef.Hosting");
    private readonly ILogger _nodeLogger = loggers.CreateLogger("Robdef.Runtime");
    private Node? _node;

    public Task StartAsync(CancellationToken cancellationToken)
    {
        RobdefNodeSettings chosen = settings.Value;
        var node = new Node(chosen.Options with
        {
            Name = chosen.Name.Length != 0 ? chosen.Name : chosen.Options.Name,
            Log = (severity, text) => Log(severity, text, chosen.Options.Log),
        });
        try
        {
            host.Begin(node, Open(node, chosen.Urls));
            _node = node;
        }
        catch (Exception)
        {
            node.Dispose();
            throw;
        }
        return Task.CompletedTask;
    }

    public async Task StopAsync(CancellationToken cancellationToken)
    {
        if (_node is { } node)
        {
            host.End();
            // It waits for handlers, at most until the host's patience ends.
            await Task.Run(node.Shutdown, CancellationToken.None).WaitAsync(cancellationToken).ConfigureAwait(false);
        }
    }

    public void Dispose() => _node?.Dispose();

    [LoggerMessage(1, LogLevel.Information, "Service at {Place}/?service={Service}")]
    private static partial void LogService(ILogger logger, string place, string service);

    [LoggerMessage(2, LogLevel.Information, "Listening at {Place}")]
    private static partial void LogPlace(ILogger logger, string place);

    // Of the node itself: the level is the event's.
    [LoggerMessage(EventId = 3, Message = "{Text}")]
    private static partial void LogOfNode(ILogger logger, LogLevel level, string text);

    private static LogLevel LevelOf(LogSeverity severity) => severity switch
    {
        LogSeverity.Debug => LogLevel.Debug,
        LogSeverity.Info => LogLevel.Information,
        LogSeverity.Warning => LogLevel.Warning,
        _ => LogLevel.Error,
    };

    private void Log(LogSeverity severity, string text, Action<LogSeverity, string>? beside)
    {
        LogLevel level = LevelOf(severity);
        LogOfNode(_nodeLogger, level, text);
        beside?.Invoke(severity, text);
    }

    /// <summary>Services first: a client that comes early finds them.</summary>
    private List<string> Open(Node node, IList<string> urls)
    {
        foreach (OfferedService service in services)
        {
            node.Register(service.Name, service.Root(provider), service.Options(provider));
        }
        var opened = new List<string>();
        foreach (string url in urls)
        {
            string place = WithPort(url, node.Listen(url));
            opened.Add(place);
            LogPlace(_logger, place);
            foreach (OfferedService service in services)
            {
                LogService(_logger, place, service.Name);
            }
        }
        return opened;
    }

    /// <summary>The URL with the port that was got for port 0.</summary>
    private static string WithPort(string url, int port)
    {
        string place = url.TrimEnd('/');
        return place.EndsWith(":0", StringComparison.Ordinal) ? $"{place[..^1]}{port}" : place;
    }
}
