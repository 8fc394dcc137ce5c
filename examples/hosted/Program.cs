// SPDX-License-Identifier: Apache-2.0
using Hosted;
using Microsoft.Extensions.Configuration;
using Microsoft.Extensions.DependencyInjection;
using Microsoft.Extensions.Hosting;
using Robdef.Hosting;

HostApplicationBuilder builder = Host.CreateApplicationBuilder(args);
builder.Services.AddRobdefNode(settings =>
{
    settings.Urls.Add("rr+tcp://localhost:6257");
    IConfigurationSection section = builder.Configuration.GetSection("Robdef");
    if (section.GetSection("Urls").Exists())
    {
        settings.Urls.Clear();
    }
    section.Bind(settings);
}).AddService<Lamp>("lamp");
// Any exporter of OpenTelemetry takes its place: it listens to the same source and meter.
builder.Services.AddHostedService<Report>();
await builder.Build().RunAsync().ConfigureAwait(false);
