// The links to the other pages of the service exist only where the service serves the guide, under /guide/.
document.documentElement.classList.toggle("served", /^https?:/.test(location.protocol) && location.pathname.startsWith("/guide/"));
