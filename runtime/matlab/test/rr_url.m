function url = rr_url()
%RR_URL Of the test service.
url = ['rr+tcp://127.0.0.1:', getenv('RR_TEST_PORT'), '/?service=bench'];
end
