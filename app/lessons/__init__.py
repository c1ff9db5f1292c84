"""Lessons: text that moves a sim. Markdown files, checked and made into HTML once, when the server starts."""
