function url = rr_served_url()
%RR_SERVED_URL Of what rr_serve serves.
url = getenv('RR_TEST_SERVED');
end
