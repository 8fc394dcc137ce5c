function options = conformance_node_options(request)
%CONFORMANCE_NODE_OPTIONS The node that a `start` request asks for, for SetNodeOptions.
options = struct('NodeID', request.node.id, 'NodeName', request.node.name);
client = struct('MessageV4', request.message_version == 4, 'StringTable', request.string_table);
server = struct('StringTable', request.string_table);
if isfield(request, 'withheld_capabilities')
  for i = 1:numel(request.withheld_capabilities)
    server = withhold(server, uint32(request.withheld_capabilities{i}));
  end
end
options.ClientOffer = client;
options.ServerOffer = server;
if isfield(request, 'heartbeat_ms')
  options.HeartbeatPeriod = request.heartbeat_ms / 1000;
end
if isfield(request, 'node_options') && isfield(request.node_options, 'memory_max_transfer')
  options.MemoryTransferLimit = request.node_options.memory_max_transfer;
end
if isfield(request, 'channel') && isfield(request.channel, 'certificate')
  options.CertificateFile = request.channel.certificate;
  options.AuthorityFiles = {request.channel.authority};
end
end

function offer = withhold(offer, capability)
% Capability codes are a page and flags (04, section 4.4).
page = bitand(capability, uint32(hex2dec('FFF00000')));
v2 = uint32(hex2dec('02000000'));
v4 = uint32(hex2dec('04000000'));
if any(page == [v2, v4]) && bitand(capability, uint32(2)) ~= 0
  offer.CombinedConnect = false;
end
if page == v4 && bitand(capability, uint32(1)) ~= 0
  offer.MessageV4 = false;
end
if page == uint32(hex2dec('04100000'))
  offer.StringTable = false;
end
end
