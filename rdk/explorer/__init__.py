"""The explorer: a rover, a mission, and at once what comes of them."""
from .app import Explorer

__all__ = ["Explorer"]
