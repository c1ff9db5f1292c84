"""The addresses: pages, the API, files, websockets."""
