"""The web application: pages, API, sessions and the bridge to viser."""
