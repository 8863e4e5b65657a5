// The link to the other pages of the service exists only where the service serves the guide, under /guide/.
document.documentElement.classList.toggle("served", /^https?:/.test(location.protocol) && location.pathname.startsWith("/guide/"));
