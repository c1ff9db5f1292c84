"""The names of learners: animals, given by the server, so that nobody is asked for one."""

from __future__ import annotations

import secrets
from collections.abc import Container

ANIMALS = (
    "Albatross Alpaca Ant Antelope Armadillo Badger Bat Bear Beaver Bee Bison Bobcat Buffalo Butterfly Camel Capybara "
    "Caribou Cat Chameleon Cheetah Chinchilla Cormorant Crab Crane Cricket Crow Deer Dingo Dolphin Dormouse Dove "
    "Dragonfly Duck Eagle Egret Elk Falcon Ferret Finch Firefly Flamingo Fox Frog Gazelle Gecko Giraffe Goose Hamster "
    "Hare Hawk Hedgehog Heron Hippo Ibex Ibis Iguana Jackal Jaguar Kestrel Kingfisher Kiwi Koala Ladybird Lemur "
    "Leopard Lion Lizard Llama Lobster Lynx Magpie Manatee Marmot Marten Meerkat Mole Moose Narwhal Newt Octopus "
    "Orca Oryx Osprey Otter Owl Panda Panther Parrot Pelican Penguin Pheasant Pika Puffin Quail Rabbit Raccoon Raven "
    "Robin Salmon Seahorse Seal Sparrow Squid Squirrel Starling Stork Swallow Swan Tapir Tiger Toucan Turtle Walrus "
    "Wombat Woodpecker Wren Yak Zebra"
).split()
"""More than a class has learners."""


def animal(taken: Container[str], wanted: str = "") -> str:
    """A name that nobody has: the one that somebody had before, if it is free."""
    free = [each for each in ANIMALS if each not in taken]
    return wanted if wanted in free else secrets.choice(free)
