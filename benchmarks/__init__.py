"""What must be fast, measured against the real server beside the plain viser way of writing the same sim."""
