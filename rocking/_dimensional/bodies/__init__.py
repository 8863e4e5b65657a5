"""Descriptions of bodies: functions of quantities. They import what they make when they are called."""
